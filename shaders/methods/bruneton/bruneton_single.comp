#version 450
#extension GL_GOOGLE_include_directive : require
// Fills the tables of the first order. A cell of a ray is lit where its centre is. An invocation is a
// texel.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#define CELL_BINDING FREE
#include "methods/bruneton/cells.glsl"
#define SINGLE_BINDING (FREE + 1)
#include "methods/bruneton/single_table.glsl"

layout(push_constant) uniform Push {
  int first_texel;
  int end_texel;
  int cells;
} push;

// Adds what a cell contributes of every constituent.
void add_cell(Real h, Real mu_s, int entry, INOUT_ARRAY(Vec4, sum, MEDIA_GROUPS_SIZE)) {
  Real density[MEDIA_SIZE];
  Real column[MEDIA_SIZE];
  densities(h, density);
  columns_to_top(h, mu_s, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 coefficient = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      coefficient = coefficient + scattering(c, g) * density[c];
    }
    Vec4 light = READ(cell_values, entry + 2 + g) * transmittance_of(column, g) /
                 max(coefficient, Vec4(1e-30));
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      sum[c * GROUPS + g] = sum[c * GROUPS + g] + light * density[c];
    }
  }
}

void keep(int index, ARRAY(Vec4, sum, MEDIA_GROUPS_SIZE)) {
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 molecules = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      if (SEPARATE) WRITE(singles, (c * GROUPS + g) * texels() + index, sum[c * GROUPS + g]);
      if (molecular(c)) molecules = molecules + scattering(c, g) * sum[c * GROUPS + g];
    }
    if (!SEPARATE) WRITE(singles, g * texels() + index, molecules);
  }
  if (SEPARATE) return;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    WRITE_REAL(first_wavelengths, c * texels() + index, sum[c * GROUPS].x);
  }
}

void main() {
  load_scene();
  load_media();
  load_grids();
  int index = push.first_texel + int(gl_GlobalInvocationID.x);
  if (index >= push.end_texel) return;
  Texel texel = texel_at(index);
  Real r = scene.planet_radius_km + node_altitude(texel.altitude);
  Real mu = node_cosine(texel.altitude, texel.zenith);
  Real mu_s = node_sun(texel.sun);
  Real nu = mu * mu_s + sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0)) *
                            cos(node_azimuth(texel.azimuth));
  Vec4 sum[MEDIA_GROUPS_SIZE];
  UNROLL for (int i = 0; i < MEDIA_GROUPS_SIZE; ++i) sum[i] = Vec4(0.0);
  for (int i = 0; i < push.cells; ++i) {
    int entry = cell_entry(texel.altitude * grid.zeniths + texel.zenith, push.cells, i);
    Real t = ray_point(entry).distance_km;
    Real h = clamp(altitude_after(r - scene.planet_radius_km, mu, t), 0.0, scene.thickness_km);
    Real mu_s_there = (r * mu_s + t * nu) / (scene.planet_radius_km + h);
    if (!meets_ground(h, mu_s_there)) add_cell(h, mu_s_there, entry, sum);
  }
  keep(index, sum);
}
