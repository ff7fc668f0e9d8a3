#version 450
#extension GL_GOOGLE_include_directive : require
// Fills the table of optical depths. An invocation is a texel.
#include "device.glsl"

layout(constant_id = 10) const int OPTICAL_DEPTH_COSINES = 2;
layout(constant_id = 11) const int OPTICAL_DEPTH_ALTITUDES = 2;

layout(binding = OWN, rgba32f) uniform restrict imageBuffer optical_depths;

#include "tables/optical_depth.glsl"

layout(push_constant) uniform Push {
  int first;
  int end;
  int first_medium;  // the depths of these constituents are added to those before them
  int end_medium;
} push;

void main() {
  load_scene();
  load_media();
  int texel = push.first + int(gl_GlobalInvocationID.x);
  if (texel >= push.end) return;
  OpticalDepthRay ray = optical_depth_ray(
      Vec2(Real(texel % OPTICAL_DEPTH_COSINES) / Real(OPTICAL_DEPTH_COSINES - 1),
           Real(texel / OPTICAL_DEPTH_COSINES) / Real(OPTICAL_DEPTH_ALTITUDES - 1)));
  Real to_top_km = distance_to_top(ray.altitude_km, ray.mu);
  Vec4 depth[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    depth[g] = push.first_medium > 0 ? READ(optical_depths, texel * GROUPS + g) : Vec4(0.0);
  }
  Real column[MEDIA_SIZE];
  some_columns_along(ray.altitude_km, ray.mu, to_top_km, push.first_medium, push.end_medium,
                     column);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    UNROLL for (int g = 0; g < GROUPS; ++g) depth[g] = depth[g] + extinction(c, g) * column[c];
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) WRITE(optical_depths, texel * GROUPS + g, depth[g]);
}
