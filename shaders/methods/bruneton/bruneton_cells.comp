#version 450
#extension GL_GOOGLE_include_directive : require
// Cuts every ray of the grid into cells. An invocation is a ray.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/march.glsl"
#define CELL_BINDING FREE
#include "methods/bruneton/cells.glsl"

layout(push_constant) uniform Push {
  int first_ray;
  int end_ray;
  int cells;
} push;

void keep_point(int entry, Real h, Real mu, Real t) {
  Real r = scene.planet_radius_km + h;
  Real altitude = clamp(altitude_after(h, mu, t), 0.0, scene.thickness_km);
  Real inverse_radius = 1.0 / (scene.planet_radius_km + altitude);
  Real mu_there = clamp((r * mu + t) * inverse_radius, -1.0, 1.0);
  Real sine = clamp(r * sqrt(max(1.0 - mu * mu, 0.0)) * inverse_radius, 0.0, 1.0);
  WRITE(cell_values, entry,
        Vec4(node_coordinate(altitude_share(source, altitude), source.altitudes),
             node_coordinate(acos(mu_there) / PI, source.zeniths), t, inverse_radius));
  WRITE(cell_values, entry + 1, Vec4(mu_there, sine, 0.0, 0.0));
}

void main() {
  load_scene();
  load_media();
  load_grids();
  int ray = push.first_ray + int(gl_GlobalInvocationID.x);
  if (ray >= push.end_ray) return;
  int a = ray / grid.zeniths;
  int z = ray % grid.zeniths;
  Real h = node_altitude(a);
  Real mu = node_cosine(a, z);
  Real length_km = path_length(h, mu, node_meets_ground(grid, h, z, mu));
  Vec4 transmittance[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) transmittance[g] = Vec4(1.0);
  for (int i = 0; i < push.cells; ++i) {
    Cell cell = cell_of_path(h, mu, length_km, push.cells, i);
    Vec4 extinguished[GROUPS];
    Vec4 scattered[GROUPS];
    int entry = cell_entry(ray, push.cells, i);
    keep_point(entry, h, mu, cross_cell(h, mu, cell, extinguished, scattered));
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      WRITE(cell_values, entry + 2 + g, transmittance[g] * scattered[g] * escaping_share(extinguished[g]));
      transmittance[g] = transmittance[g] * exp(-extinguished[g]);
    }
  }
  int end = cell_entry(ray, push.cells, push.cells);
  keep_point(end, h, mu, length_km);
  UNROLL for (int g = 0; g < GROUPS; ++g) WRITE(cell_values, end + 2 + g, transmittance[g]);
}
