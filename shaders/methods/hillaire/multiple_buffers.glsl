// The tables of multiple scattering in a kernel that reads them.
layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer log_multiple;
layout(binding = OWN + 3, rgba32f) uniform restrict readonly imageBuffer log_irradiance;

#include "methods/hillaire/multiple.glsl"
