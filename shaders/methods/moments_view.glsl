// What the kernels that read the finished moments have in common.
#include "device.glsl"
#include "methods/moments_phase.glsl"
#include "methods/moments.glsl"

// All orders together, [altitude][sun][moment][group], then the irradiance of the ground by sun.
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer moments;
