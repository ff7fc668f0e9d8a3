// Where light is in a shell, for walks to go there: with a low sun most of the air is dark, and
// walks that did not know would rarely meet the rest.
#pragma once

#include "engine/physics/pack.h"

namespace cyanometer {

/// Appends what lies behind light_offset() in `path_guide` (shaders/methods/path.glsl), and
/// makes walks use it. Depends on the air and the ground, neither on the sun nor on the camera.
void append_light_guide(Physics<double>& physics, const Problem& problem);

/// Whether the sun is low anywhere where the camera sees air.
bool needs_light_guide(const Problem& problem);

}  // namespace cyanometer
