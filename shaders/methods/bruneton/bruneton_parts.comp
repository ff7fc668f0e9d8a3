#version 450
#extension GL_GOOGLE_include_directive : require
// Adds the orders from the second on to those rays of a tile that end at something: what is scattered along them,
// gathered from the source. A difference of what is seen from both ends [Bruneton and Neyret 2008, section 4]
// loses what is left of short parts to interpolation. An invocation is a ray.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/march.glsl"
#define SOURCE_BINDING FREE
#include "methods/bruneton/source_table.glsl"
layout(binding = FREE + 1, rgba32f) uniform restrict imageBuffer tile;

layout(push_constant) uniform Push {
  int first;      // of this dispatch
  int end;
  int first_ray;  // of the tile, in the frame
  int rays_in_tile;
  int cells;
} push;

void main() {
  load_scene();
  load_media();
  load_grids();
  int i = push.first + int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= push.end) return;
  Path path = path_of_ray(push.first_ray + i, pixel_ray(push.first_ray + i));
  if (!path.cut) return;
  Vec3 sun = Vec3(scene.sun_direction.x, scene.sun_direction.y, scene.sun_direction.z);
  Real nu = dot(path.direction, sun);
  Vec4 radiance[GROUPS];
  Vec4 transmittance[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    radiance[g] = Vec4(0.0);
    transmittance[g] = Vec4(1.0);
  }
  for (int k = 0; k < push.cells; ++k) {
    Cell cell = cell_of_path(path.altitude_km, path.mu, path.length_km, push.cells, k);
    Vec4 depth[GROUPS];
    Vec4 scattered[GROUPS];
    Real place = cross_cell(path.altitude_km, path.mu, cell, depth, scattered);
    Vec3 position = path.start + path.direction * place;
    Real h = clamp(altitude_after(path.altitude_km, path.mu, place), 0.0, scene.thickness_km);
    Real r = scene.planet_radius_km + path.altitude_km;
    Real mu = clamp((r * path.mu + place) / (scene.planet_radius_km + h), -1.0, 1.0);
    Real mu_s = clamp(dot(position, sun) / length(position), -1.0, 1.0);
    SourcePosition at = source_position(
        node_coordinate(altitude_share(source, h), source.altitudes),
        node_coordinate(acos(mu) / PI, source.zeniths), mu_s,
        azimuth_cosine(mu, sqrt(max(1.0 - mu * mu, 0.0)), mu_s, nu));
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      radiance[g] = radiance[g] + transmittance[g] * scattered[g] * escaping_share(depth[g]) *
                                      source_at(at, g);
      transmittance[g] = transmittance[g] * exp(-depth[g]);
    }
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int to = (INSCATTER * GROUPS + g) * n + i;
    WRITE(tile, to, READ(tile, to) + radiance[g]);
  }
}
