// The table of optical depths in a kernel that reads it: define OPTICAL_DEPTH_BINDING, include this
// after device.glsl, append the table's constants to the scene's
// (engine/methods/tables/optical_depth_table.h).
layout(constant_id = 10) const int OPTICAL_DEPTH_COSINES = 2;
layout(constant_id = 11) const int OPTICAL_DEPTH_ALTITUDES = 2;

layout(binding = OPTICAL_DEPTH_BINDING, rgba32f) uniform restrict readonly imageBuffer optical_depths;

#include "tables/optical_depth.glsl"
