// All orders of scattering from precomputed tables [Bruneton and Neyret 2008; Bruneton 2017]:
// shaders/methods/bruneton/.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& bruneton_description();
std::unique_ptr<Method> make_bruneton(vulkan::Device& device);

}  // namespace cyanometer
