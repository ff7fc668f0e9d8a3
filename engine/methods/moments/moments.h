// The `moments` method (shaders/methods/moments.glsl).
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& moments_description();
std::unique_ptr<Method> make_moments(vulkan::Device& device);

}  // namespace cyanometer
