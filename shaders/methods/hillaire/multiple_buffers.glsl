// The tables of multiple scattering in a kernel that reads them.
layout(std430, binding = OWN + 2) restrict readonly buffer MultipleBuffer { Vec4 log_multiple[]; };
layout(std430, binding = OWN + 3) restrict readonly buffer IrradianceBuffer { Vec4 log_irradiance[]; };

#include "methods/hillaire/multiple.glsl"
