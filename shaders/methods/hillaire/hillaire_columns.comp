#version 450
#extension GL_GOOGLE_include_directive : require
// Exact columns along the rays from an altitude. An invocation is a node.
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/multiple_buffers.glsl"

layout(binding = OWN + 4, r32f) uniform restrict imageBuffer view_columns;

#include "methods/hillaire/view.glsl"

layout(push_constant) uniform Push {
  int first;  // node
  int end;
  int first_medium;
  int end_medium;
  float altitude_km;
} push;

void main() {
  load_scene();
  load_media();
  int node = push.first + int(gl_GlobalInvocationID.x);
  if (node >= push.end) return;
  take_out_forward_peak();
  bool ground = node >= VIEW_NODES;
  Real x = Real(node % VIEW_NODES) / Real(VIEW_NODES - 1);
  Real mu = elevation_cosine_at(push.altitude_km, x, ground);
  SunlitRay ray = sunlit_ray(push.altitude_km, mu, ground, 0.0, 0.0);
  Real column[MEDIA_SIZE];
  some_columns_along(ray.altitude_km, ray.mu, ray.length_km, push.first_medium, push.end_medium,
                     column);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    if (c >= push.first_medium && c < push.end_medium) WRITE_REAL(view_columns, node * MEDIA + c, column[c]);
  }
}
