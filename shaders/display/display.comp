#version 450
#extension GL_GOOGLE_include_directive : require
#define Real float
#define Vec3 vec3
#define Vec4 vec4
#define CONSTANT const
#include "display/tone.glsl"

// Linear planes of a frame to packed 8-bit sRGB, four bytes a pixel: R, G, B, 255.
layout(local_size_x = 64) in;
layout(constant_id = 0) const int TONE_MAP = 0;
layout(constant_id = 1) const bool PAINT_CLIPPED = false;

layout(binding = 0, r32f) uniform restrict readonly imageBuffer red;
layout(binding = 1, r32f) uniform restrict readonly imageBuffer green;
layout(binding = 2, r32f) uniform restrict readonly imageBuffer blue;
layout(binding = 3, r32ui) uniform restrict writeonly uimageBuffer pixels;

layout(push_constant) uniform Push {
  vec4 row0;  // exposure times white balance
  vec4 row1;
  vec4 row2;
  int first;
  int end;
} push;

float greatest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Whether a colour is too bright to be shown. No grey comes out of AgX as white, however bright: there it is
// one beyond the curve's range. The other two that reach no end show as white in 8 bits what is near enough.
bool clips(vec3 rgb, vec3 shown) {
  if (greatest(shown) > 1.0) return true;
  if (TONE_MAP == TONE_AGX) return greatest(agx_inset(rgb)) > exp2(AGX_MOST_EV);
  bool endless = TONE_MAP == TONE_REINHARD || TONE_MAP == TONE_EXPONENTIAL;
  return endless && srgb_encoded(greatest(shown)) * 255.0 >= 254.5;
}

void main() {
  int i = push.first + int(gl_GlobalInvocationID.x);
  if (i >= push.end) return;
  vec3 linear = by_rows(push.row0.xyz, push.row1.xyz, push.row2.xyz,
                        vec3(imageLoad(red, i).x, imageLoad(green, i).x, imageLoad(blue, i).x));
  vec3 rgb = into_gamut(linear);
  vec3 shown = tone_mapped(TONE_MAP, rgb);
  bool clipped = clips(rgb, shown);
  shown = clamp(shown, 0.0, 1.0);
  vec3 encoded = vec3(srgb_encoded(shown.x), srgb_encoded(shown.y), srgb_encoded(shown.z));
  if (PAINT_CLIPPED && clipped) encoded = vec3(1.0, 0.0, 1.0);
  uvec3 bytes = uvec3(encoded * 255.0 + 0.5);
  imageStore(pixels, i, uvec4(bytes.x | (bytes.y << 8) | (bytes.z << 16) | 0xff000000u));
}
