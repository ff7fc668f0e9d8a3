// Single scattering by Gauss-Legendre quadrature, every ray cut where its light bends or jumps:
// shaders/methods/raymarch.glsl.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& raymarch_description();
std::unique_ptr<Method> make_raymarch(vulkan::Device& device);

/// For methods whose first order is this march: pieces of a ray whose loops together stay below
/// the drivers' limit, and the evaluations that a ray costs under one sun.
/// @throws OverLimit
int march_pieces_at_once(const UploadedScene& scene, int view_nodes);

/// Evaluations of one ray, under all points of the sun's disc, as plans reckon.
double evaluations_of_march(const Problem& problem, double view_nodes);
std::int64_t march_evaluations(std::int64_t media, int view_nodes);

}  // namespace cyanometer
