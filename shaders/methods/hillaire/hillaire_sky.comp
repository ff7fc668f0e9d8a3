#version 450
#extension GL_GOOGLE_include_directive : require
// Fills the sky view. An invocation is a texel.
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/multiple_buffers.glsl"

layout(binding = OWN + 4, r32f) uniform restrict readonly imageBuffer view_columns;
layout(binding = OWN + 5, rgba32f) uniform restrict imageBuffer sky_view;

#include "methods/hillaire/view.glsl"
#include "methods/hillaire/sky_view.glsl"

layout(push_constant) uniform Push {
  int first;  // texel
  int end;
  int samples;
  int all_orders;
  float scale_height_km;
} push;

void main() {
  load_scene();
  load_media();
  int texel = push.first + int(gl_GlobalInvocationID.x);
  if (texel >= push.end) return;
  take_out_forward_peak();
  int row = texel / SKY_VIEW_AZIMUTHS;
  SunlitRay ray = sky_ray(texel % SKY_VIEW_AZIMUTHS, row % SKY_VIEW_ELEVATIONS,
                          scene.camera_altitude_km, scene.sun_direction.z);
  if (SKY_VIEW_STOPS > 1) {
    ray.length_km = stop_km(stops_on(ray), row / SKY_VIEW_ELEVATIONS, SKY_VIEW_STOPS);
  }
  Path idle;
  Real column[MEDIA_SIZE];
  Vec4 once[MEDIA_GROUPS_SIZE];
  Vec4 further[GROUPS];
  march_view(ray, idle, 0, push.samples, push.scale_height_km, push.all_orders != 0,
             column, once, further);
  make_ratios(column, once, further);
  int planes = sky_planes();
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int plane = 0;
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      if (medium(c).phase == PHASE_NONE) continue;
      WRITE(sky_view, (texel * planes + plane) * GROUPS + g, once[c * GROUPS + g]);
      ++plane;
    }
    WRITE(sky_view, (texel * planes + plane) * GROUPS + g, further[g]);
  }
}
