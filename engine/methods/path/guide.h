// What the proposals of the walks know of a scene (shaders/methods/path.glsl): where scattering
// happens and which constituents have forward peaks. It decides how noisy results are, never
// what they are.
#pragma once

#include "engine/physics/pack.h"

namespace cyanometer {

/// The buffer `path_guide` of shaders/methods/path.glsl, for a packed scene.
std::vector<double> path_guide(Physics<double>& physics);

}  // namespace cyanometer
