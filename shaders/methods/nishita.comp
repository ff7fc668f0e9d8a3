#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "device.glsl"
#include "methods/nishita.glsl"

layout(binding = OWN, rgba32f) uniform restrict imageBuffer tile;
// Columns to the camera and to the sun of every constituent, between two dispatches.
layout(binding = OWN + 1, r32f) uniform restrict imageBuffer columns;

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int view_samples;
  int light_samples;
  MarchRange range;   // of this dispatch; the view sample after the last one is the ground
} push;

void main() {
  load_scene();
  load_media();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);

  Real view_column[MEDIA_SIZE];
  Real light_column[MEDIA_SIZE];
  Vec4 radiance[GROUPS];
  bool ground = push.range.first_view == push.view_samples;
  bool fresh = push.range.first_sun == 0 && push.range.first_light == 0 &&
               (ground || push.range.first_view == 0);
  bool no_columns = fresh && !ground;
  int quantity = ground ? GROUND : INSCATTER;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    view_column[c] = no_columns ? 0.0 : READ_REAL(columns, c * n + i);
    light_column[c] = no_columns ? 0.0 : READ_REAL(columns, (MEDIA + c) * n + i);
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    radiance[g] = fresh ? Vec4(0.0) : READ(tile, (quantity * GROUPS + g) * n + i);
  }
  if (ground) {
    if (scene.surface == 0) {
      light_ground(path, push.range, push.light_samples, light_column, radiance);
    }
  } else {
    march_view(path, push.range, push.view_samples, push.light_samples, view_column,
               light_column, radiance);
  }
  // With the ground's last part the ray is done: the air in front of it is known.
  bool done = ground && push.range.end_sun == scene.disc_points &&
              push.range.end_light == push.light_samples;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(view_column, g);
    if (done) {
      radiance[g] = radiance[g] * transmittance;
      WRITE(tile, (TRANSMITTANCE * GROUPS + g) * n + i, transmittance);
    }
    WRITE(tile, (quantity * GROUPS + g) * n + i, radiance[g]);
  }
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    WRITE_REAL(columns, c * n + i, view_column[c]);
    WRITE_REAL(columns, (MEDIA + c) * n + i, light_column[c]);
  }
}
