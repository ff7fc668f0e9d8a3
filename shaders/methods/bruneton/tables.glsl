// What the kernels of the tables stand on: the grid of the rays at hand, that of the source table, and
// the rays' nodes. Included after device.glsl; bindings of its own begin at FREE.
#include "methods/bruneton/grid.glsl"

// Values are interpolated as logarithms.
layout(constant_id = 10) const bool LOGARITHMIC = true;

layout(std430, binding = OWN) restrict readonly buffer GridBuffer {
  ScatteringGrid stored_grid;    // of the rays
  ScatteringGrid stored_source;  // of what they gather: zeniths and azimuths are even in angle
};
ScatteringGrid grid, source;

// main() begins with it.
void load_grids() {
  grid = stored_grid;
  source = stored_source;
}

// Altitudes (km), sun cosines, then for each altitude the zenith cosines, then their weights in an
// integral over the zenith cosine.
layout(binding = OWN + 1, r32f) uniform restrict readonly imageBuffer nodes;
#define FREE (OWN + 2)  // bindings of a kernel's own

Real node_altitude(int a) { return READ_REAL(nodes, a); }
Real node_sun(int s) { return READ_REAL(nodes, grid.altitudes + s); }
int first_cosine() { return grid.altitudes + grid.suns; }
Real node_cosine(int a, int z) { return READ_REAL(nodes, first_cosine() + a * grid.zeniths + z); }
Real node_weight(int a, int z) {
  return READ_REAL(nodes, first_cosine() + (grid.altitudes + a) * grid.zeniths + z);
}
Real node_azimuth(int k) { return PI * Real(k) / Real(max(grid.azimuths - 1, 1)); }

Vec3 direction_of(Real mu, Real azimuth) {
  Real sine = sqrt(max(1.0 - mu * mu, 0.0));
  return Vec3(sine * cos(azimuth), sine * sin(azimuth), mu);
}

// What a node of direction stands for in an integral, sr: both sides, left and right of the sun, together.
Real node_solid_angle(int a, int z, int k) {
  bool at_end = k == 0 || k == grid.azimuths - 1;
  return node_weight(a, z) * (at_end ? 1.0 : 2.0) * PI / Real(grid.azimuths - 1);
}

// On the ground what looks down has come to it, along the horizon too.
Real path_length(Real h, Real mu, bool below) {
  if (below) return h > 0.0 ? distance_to_ground(h, mu) : 0.0;
  return distance_to_top(h, mu);
}

// A texel of a table over the whole grid; azimuths are next to each other, then zeniths, suns,
// altitudes.
struct Texel {
  int altitude, sun, zenith, azimuth;
};

Texel texel_at(int index) {
  Texel texel;
  texel.azimuth = index % grid.azimuths;
  int rest = index / grid.azimuths;
  texel.zenith = rest % grid.zeniths;
  rest = rest / grid.zeniths;
  texel.sun = rest % grid.suns;
  texel.altitude = rest / grid.suns;
  return texel;
}

int texels() { return grid.altitudes * grid.suns * grid.zeniths * grid.azimuths; }

// --- Interpolation ------------------------------------------------------------------------------

Vec4 encoded(Vec4 value) { return LOGARITHMIC ? log(max(value, Vec4(1e-30))) : value; }
Vec4 decoded(Vec4 value) { return LOGARITHMIC ? exp(value) : value; }

// The lower of two neighbours, and the share of the upper one.
struct Between {
  int node;
  Real share;
};

Between between(Real coordinate, int count) {
  Between position;
  position.node = clamp(int(coordinate), 0, max(count - 2, 0));
  position.share = coordinate - Real(position.node);
  return position;
}

Between between_suns(ScatteringGrid of, Real mu_s) {
  return between(node_coordinate(sun_share(of, mu_s), of.suns), of.suns);
}
