// Tables of transmittance, multiple scattering and the sky's view [Hillaire 2020, "A Scalable
// and Production Ready Sky and Atmosphere Rendering Technique"]: shaders/methods/hillaire/.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

const MethodDescription& hillaire_description();
std::unique_ptr<Method> make_hillaire(vulkan::Device& device);

}  // namespace cyanometer
