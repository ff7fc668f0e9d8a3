// From a direction to a pixel: the inverse of shaders/physics/camera.glsl, in double.
#pragma once

#include <optional>

#include "engine/physics/pack.h"

namespace cyanometer {

/// The pixel whose area a direction falls into, none where the camera does not see it.
std::optional<int> pixel_of(const Physics<double>& camera, const glm::dvec3& direction);

/// Solid angle of a pixel, sr, at its centre.
double pixel_solid_angle(const Physics<double>& camera, int pixel);

}  // namespace cyanometer
