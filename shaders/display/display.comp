#version 450
#extension GL_GOOGLE_include_directive : require
#include "display/show.glsl"
#include "display/packed.glsl"

// Linear planes of a frame to packed 8-bit sRGB: of all pixels, or of those that are listed, whose levels are
// left as they are before they are rounded for those that lie between.
layout(local_size_x = 64) in;
layout(constant_id = 2) const bool LISTED = false;

layout(binding = 0, r32f) uniform readonly imageBuffer red;
layout(binding = 1, r32f) uniform readonly imageBuffer green;
layout(binding = 2, r32f) uniform readonly imageBuffer blue;
layout(binding = 3, r32ui) uniform writeonly uimageBuffer pixels;
layout(binding = 4, r32ui) uniform readonly uimageBuffer listed;
layout(binding = 5, r32f) uniform writeonly imageBuffer red_level;
layout(binding = 6, r32f) uniform writeonly imageBuffer green_level;
layout(binding = 7, r32f) uniform writeonly imageBuffer blue_level;

layout(push_constant) uniform Push {
  vec4 row0;  // exposure times white balance
  vec4 row1;
  vec4 row2;
  int first;
  int end;
} push;

void main() {
  int i = push.first + int(gl_GlobalInvocationID.x);
  if (i >= push.end) return;
  int at = LISTED ? int(imageLoad(listed, i).x) : i;
  vec3 levels = levels_of(by_rows(push.row0.xyz, push.row1.xyz, push.row2.xyz,
                                  vec3(imageLoad(red, at).x, imageLoad(green, at).x, imageLoad(blue, at).x)));
  imageStore(pixels, at, uvec4(packed(levels)));
  if (LISTED) {
    imageStore(red_level, at, vec4(levels.x));
    imageStore(green_level, at, vec4(levels.y));
    imageStore(blue_level, at, vec4(levels.z));
  }
}
