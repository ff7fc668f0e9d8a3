// Single scattering by a nested march [Nishita, Sirai, Tadamura and Nakamae 1993]:
// shaders/methods/ nishita.glsl.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& nishita_description();
std::unique_ptr<Method> make_nishita(vulkan::Device& device);

}  // namespace cyanometer
