// Sizes of the tables of Hillaire's method, as the kernels are specialised by them; 10 and 11 are those of
// the optical depths. The buffers of all kernels have the same bindings, 8 to 12; the last differs.
layout(constant_id = 12) const int MULTIPLE_SUNS = 2;
layout(constant_id = 13) const int MULTIPLE_ALTITUDES = 2;
layout(constant_id = 14) const int SKY_AZIMUTHS = 2;
layout(constant_id = 15) const int SKY_ELEVATIONS = 4;

#define OPTICAL_DEPTH_BINDING 8
#include "tables/optical_depth_buffer.glsl"
#include "methods/hillaire/coordinates.glsl"
#include "methods/hillaire/march.glsl"
