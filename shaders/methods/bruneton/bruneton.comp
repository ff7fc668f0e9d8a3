#version 450
#extension GL_GOOGLE_include_directive : require
// Adds the orders from the second on to a tile that holds the first: what the air scatters from the table,
// and the ground under its diffuse light. An invocation is a ray.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/view_table.glsl"
#define VIEW_BINDING FREE
#include "methods/bruneton/multiple_view.glsl"
#define IRRADIANCE_BINDING (FREE + 1)
#include "methods/bruneton/irradiance_table.glsl"
layout(binding = FREE + 2, rgba32f) uniform restrict imageBuffer tile;

layout(push_constant) uniform Push {
  int first_ray;
  int rays_in_tile;
} push;

void main() {
  load_scene();
  load_grids();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  Vec3 end = path.start + path.direction * path.length_km;
  Real mu_s = dot(end, towards_sun()) / length(end);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (!ends_on_ground(path)) continue;
    int ground = (GROUND * GROUPS + g) * n + i;
    WRITE(tile, ground,
          READ(tile, ground) + ground_seen(left_by_ground(diffuse_irradiance(mu_s, g), g),
                                           READ(tile, (TRANSMITTANCE * GROUPS + g) * n + i)));
  }
  if (path.cut || !(path.length_km > 0.0)) return;
  ViewPosition at = view_position(path);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int inscatter = (INSCATTER * GROUPS + g) * n + i;
    WRITE(tile, inscatter, READ(tile, inscatter) + scattered(at, g));
  }
}
