// Vertical profiles of density, integrated exactly.
#pragma once

#include "engine/scene/scene.h"

namespace cyanometer {

/// The profile with a table divided by its maximum (a table of zeros stays as it is).
Profile normalised(Profile profile);

/// The integral of the normalised profile over altitude, from the ground to the hard top, km:
/// the length of an evenly dense column (profile 1) of as much matter. 0 where there is none.
double column_km(const Profile& profile, double thickness_km);

}  // namespace cyanometer
