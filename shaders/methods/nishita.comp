#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"
#include "methods/nishita.glsl"

// inscatter, ground and transmittance of the tile's rays; the columns between two dispatches.
layout(std430, binding = 8) restrict buffer TileBuffer { Vec4 tile[]; };
layout(std430, binding = 9) restrict buffer ColumnBuffer { Real columns[]; };

layout(push_constant) uniform Push {
  int first_ray;     // of the tile, in the frame
  int rays_in_tile;
  int first_sample;  // of this dispatch, along the view ray
  int end_sample;
  int view_samples;
  int light_samples;
} push;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  load_scene();
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_from_camera(pixel.direction);
  if (!pixel.inside) path.length_km = 0.0;

  Real view_column[MEDIA_SIZE];
  Vec4 inscatter[GROUPS];
  bool fresh = push.first_sample == 0;
  for (int c = 0; c < MEDIA; ++c) view_column[c] = fresh ? 0.0 : columns[c * n + i];
  for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = fresh ? Vec4(0.0) : tile[(INSCATTER * GROUPS + g) * n + i];
  }
  march_view(path, push.first_sample, push.end_sample, push.view_samples, push.light_samples,
             view_column, inscatter);
  for (int g = 0; g < GROUPS; ++g) tile[(INSCATTER * GROUPS + g) * n + i] = inscatter[g];
  if (push.end_sample < push.view_samples) {
    for (int c = 0; c < MEDIA; ++c) columns[c * n + i] = view_column[c];
    return;
  }
  Vec4 ground[GROUPS];
  sunlit_ground(path, push.light_samples, ground);
  for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(view_column, g);
    tile[(GROUND * GROUPS + g) * n + i] = ground[g] * transmittance;
    tile[(TRANSMITTANCE * GROUPS + g) * n + i] = transmittance;
  }
}
