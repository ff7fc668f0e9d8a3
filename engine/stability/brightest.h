// What no method may exceed: energy, as a bound on radiance.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

/// By wavelength, in the scene's unit: a radiance that no ray can have. A beam of irradiance E
/// has a radiance of at most E times the largest value of a phase function, or E / pi from the
/// ground, when it has been scattered once; each further order is a mean of the one before it,
/// so the sum of N orders is at most N times that. Of all orders 64 are counted, which is far
/// above what air that loses nothing returns. Infinite where the ground differs from place to
/// place, for water has no largest reflectance, and where the sun may stand in the air.
std::vector<double> brightest_possible(const Scene& scene,
                                       const std::vector<double>& wavelengths_nm);

}  // namespace cyanometer
