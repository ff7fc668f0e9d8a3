#version 450
#extension GL_GOOGLE_include_directive : require
// The first order of a tile from its tables, and the transmittance and the sunlit ground by quadrature. An
// invocation is a ray.
#define ANY_PROJECTION
#include "device.glsl"
#include "methods/raymarch.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/view_table.glsl"
#define SINGLE_BINDING FREE
#include "methods/bruneton/single_table.glsl"
#include "methods/bruneton/single_view.glsl"
layout(binding = FREE + 2, rgba32f) uniform restrict imageBuffer tile;

layout(push_constant) uniform Push {
  int first_ray;
  int rays_in_tile;
} push;

void main() {
  load_scene();
  load_media();
  load_grids();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  if (path.cut) return;
  Vec4 inscatter[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = Vec4(0.0);
    ground[g] = Vec4(0.0);
  }
  if (path.length_km > 0.0) add_single(path, inscatter);
  if (scene.surface == 0) light_ground_from(path, 0, ground);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, path.length_km, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(column, g);
    WRITE(tile, (INSCATTER * GROUPS + g) * n + i, inscatter[g]);
    WRITE(tile, (GROUND * GROUPS + g) * n + i, ground[g] * transmittance);
    WRITE(tile, (TRANSMITTANCE * GROUPS + g) * n + i, transmittance);
  }
}
