// What the proposals of the walks know of a scene (shaders/methods/path.glsl): where scattering
// happens and which constituents have forward peaks. It decides how noisy results are, never
// what they are.
#pragma once

#include "engine/physics/pack.h"

namespace cyanometer {

/// Fills the buffer `path_guide` of a packed scene; its part on the light only where the sun is
/// low (light_guide.h).
void set_path_guide(Physics<double>& physics, const Problem& problem);

}  // namespace cyanometer
