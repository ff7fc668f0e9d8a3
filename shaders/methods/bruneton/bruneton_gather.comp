#version 450
#extension GL_GOOGLE_include_directive : require
// Radiance of one order along every ray of the grid, from its source and the light that the order before
// leaves on the ground [Bruneton and Neyret 2008, equations 7 and 9]. An invocation is a texel.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#define CELL_BINDING FREE
#include "methods/bruneton/cells.glsl"
#define SOURCE_BINDING (FREE + 1)
#include "methods/bruneton/source_table.glsl"
#define IRRADIANCE_BINDING (FREE + 2)
#include "methods/bruneton/irradiance_table.glsl"
layout(std430, binding = FREE + 3) restrict writeonly buffer RadianceBuffer {
  Vec4 radiances[];
};

layout(push_constant) uniform Push {
  int first_texel;
  int end_texel;
  int cells;
  int with_ground;  // the ground's light too
  int encode;       // as what is interpolated; else the radiance itself
} push;

void main() {
  load_scene();
  load_grids();
  int index = push.first_texel + int(gl_GlobalInvocationID.x);
  if (index >= push.end_texel) return;
  Texel texel = texel_at(index);
  Real h = node_altitude(texel.altitude);
  Real r = scene.planet_radius_km + h;
  Real mu = node_cosine(texel.altitude, texel.zenith);
  Real mu_s = node_sun(texel.sun);
  Real nu = mu * mu_s + sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0)) *
                            cos(node_azimuth(texel.azimuth));
  int ray = texel.altitude * grid.zeniths + texel.zenith;
  Vec4 radiance[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) radiance[g] = Vec4(0.0);
  for (int i = 0; i < push.cells; ++i) {
    int entry = cell_entry(ray, push.cells, i);
    RayPoint point = ray_point(entry);
    Real mu_s_there =
        clamp((r * mu_s + point.distance_km * nu) * point.inverse_radius, -1.0, 1.0);
    SourcePosition at =
        source_position(point.altitude_coordinate, point.zenith_coordinate, mu_s_there,
                        azimuth_cosine(point.mu, point.sine, mu_s_there, nu));
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      radiance[g] = radiance[g] + READ(cell_values, entry + 2 + g) * source_at(at, g);
    }
  }
  if (push.with_ground != 0 && node_meets_ground(grid, h, texel.zenith, mu)) {
    int end = cell_entry(ray, push.cells, push.cells);
    Real mu_s_there =
        (r * mu_s + ray_point(end).distance_km * nu) / scene.planet_radius_km;
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      radiance[g] = radiance[g] + READ(cell_values, end + 2 + g) * lambertian(g) *
                                      diffuse_irradiance(mu_s_there, g);
    }
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    radiances[g * texels() + index] = push.encode != 0 ? encoded(radiance[g]) : radiance[g];
  }
}
