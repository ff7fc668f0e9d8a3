// One scene for all that are nearly alike, so that what was measured for one frame of a
// sequence holds for the next.
#pragma once

#include "engine/scene/scene.h"

namespace cyanometer {

/// The scene with its sun and its camera on a grid that is fine against what errors change
/// over: the sun to a degree or two, half of one when low; the camera to an eighth of its field
/// of view unless it looks past the planet, its altitude to a quarter; the number of pixels up
/// by a fifth at most, so that they cost no more than was reckoned, and how much there is of
/// each constituent up by a twelfth. A function of the scene
/// alone.
Scene nearby(const Scene& scene);

}  // namespace cyanometer
