// All orders by Monte Carlo, the reference that states its own error:
// shaders/methods/path.glsl.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& path_description();
std::unique_ptr<Method> make_path(vulkan::Device& device);

}  // namespace cyanometer
