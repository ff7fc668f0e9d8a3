#version 450
#extension GL_GOOGLE_include_directive : require
// Adds the orders from the second on to a tile that holds the first: what the air scatters from the table,
// and the ground under its diffuse light. An invocation is a ray.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/view_table.glsl"
layout(std430, binding = FREE) restrict readonly buffer ViewBuffer { Vec4 views[]; };
#define IRRADIANCE_BINDING (FREE + 1)
#include "methods/bruneton/irradiance_table.glsl"
layout(std430, binding = FREE + 2) restrict buffer TileBuffer { Vec4 tile[]; };

layout(push_constant) uniform Push {
  int first_ray;
  int rays_in_tile;
} push;

Vec4 view_in_direction(ViewPosition at, int texel) {
  int next = texel + grid.azimuths;
  return mix(mix(views[texel], views[texel + 1], at.azimuth.share),
             mix(views[next], views[next + 1], at.azimuth.share), at.zenith.share);
}

Vec4 scattered(ViewPosition at, int group) {
  Vec4 value = Vec4(0.0);
  UNROLL for (int s = 0; s < VIEW_SUNS; ++s) {
    UNROLL for (int a = 0; a < VIEW_ALTITUDES; ++a) {
      Real weight = (s == 0 ? 1.0 - at.sun.share : at.sun.share) *
                    (a == 0 ? 1.0 - at.altitude.share : at.altitude.share);
      int texel = group * texels() + view_texel(at, a, s);
      value = value + weight * view_in_direction(at, texel);
    }
  }
  return decoded(value);
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  load_scene();
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_from_camera(pixel.direction);
  if (!pixel.inside || !meets_planet(path)) return;
  ViewPosition at = view_position(path);
  Vec3 end = path.start + path.direction * path.length_km;
  Real mu_s = dot(end, towards_sun()) / scene.planet_radius_km;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (path.length_km > 0.0) {
      int inscatter = (INSCATTER * GROUPS + g) * n + i;
      tile[inscatter] = tile[inscatter] + scattered(at, g);
    }
    if (path.meets_ground) {
      int ground = (GROUND * GROUPS + g) * n + i;
      tile[ground] = tile[ground] + lambertian(g) * diffuse_irradiance(mu_s, g) *
                                        tile[(TRANSMITTANCE * GROUPS + g) * n + i];
    }
  }
}
