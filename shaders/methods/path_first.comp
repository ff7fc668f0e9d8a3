#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"
#include "methods/nishita.glsl"

layout(std430, binding = 8) restrict buffer TileBuffer { Vec4 tile[]; };

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
} push;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  load_scene();
  load_media();
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_from_camera(pixel.direction);
  if (!pixel.inside) {
    path.length_km = 0.0;
    path.meets_ground = false;
  }
  Real view_column[MEDIA_SIZE];
  Real light_column[MEDIA_SIZE];
  Vec4 inscatter[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int c = 0; c < MEDIA; ++c) view_column[c] = 0.0;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = Vec4(0.0);
    ground[g] = Vec4(0.0);
  }
  march_view(path, whole_march(100, 20), 100, 20, view_column, light_column, inscatter);
  light_ground(path, whole_march(100, 20), 20, light_column, ground);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(view_column, g);
    tile[(INSCATTER * GROUPS + g) * n + i] = inscatter[g];
    tile[(GROUND * GROUPS + g) * n + i] = ground[g] * transmittance;
    tile[(TRANSMITTANCE * GROUPS + g) * n + i] = transmittance;
    tile[(STANDARD_ERROR * GROUPS + g) * n + i] = Vec4(0.0);
  }
}
