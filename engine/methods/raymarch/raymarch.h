// Single scattering by Gauss-Legendre quadrature, every ray cut where its light bends or jumps:
// shaders/methods/raymarch.glsl.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& raymarch_description();
std::unique_ptr<Method> make_raymarch(vulkan::Device& device);

}  // namespace cyanometer
