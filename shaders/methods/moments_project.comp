#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// Adds an order to the sum and leaves it as the next one reads it. They are written down first, for what is
// done with each is long when unrolled.
void keep(int i, int s, int g, Vec4 moment[SLOTS]) {
  int at = moment_at(i, s, 0) + g;
  UNROLL for (int n = 0; n < SLOTS; ++n) WRITE(moments, at + n * GROUPS, moment[n]);
  Vec4 lowest = moment[0];
  ROLLED for (int n = 0; n < SLOTS; ++n) {
    int own = at + n * GROUPS;
    int sum = sum_table() + own;
    Vec4 value = READ(moments, own);
    WRITE(moments, sum, READ(moments, sum) + value);
    WRITE(moments, own, n == 0 ? moment_logarithm(lowest) : moment_ratio(value, lowest));
  }
}

void keep_irradiance(int s, int g, Vec4 irradiance) {
  int at = irradiance_at(push.grid.altitudes, s) + g;
  WRITE(moments, sum_table() + at, READ(moments, sum_table() + at) + irradiance);
  WRITE(moments, at, moment_logarithm(irradiance));
}

// The moments of the light that the rays bring, of one order: one invocation an altitude, a sun and a
// group of wavelengths.
void main() {
  load_scene();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int i = index / GROUPS / push.grid.suns;
  Vec4 moment[SLOTS];
  UNROLL for (int n = 0; n < SLOTS; ++n) moment[n] = Vec4(0.0);
  Vec4 irradiance = Vec4(0.0);
  Real mu_s = 0.0;
  for (int j = 0; j < RAYS; ++j) {
    TableRay ray = table_ray(i, j);
    mu_s = sun_of_node(push.grid, sun_range(push.grid, ray.altitude_km), Real(s));
    Real weight = ray.weight * 2.0 * PI / Real(AZIMUTHS);
    Real p[MOST_MOMENTS];
    zenith_polynomials(ray.mu, DEGREE, p);
    int at = light_at(i, j, s) + g;
    UNROLL for (int m = 0; m <= DEGREE; ++m) {
      Vec4 term = READ(light, at + m * GROUPS) * weight;
      if (m == 0 && !ray.down) irradiance = irradiance + term * ray.mu;
      UNROLL for (int l = 0; l <= DEGREE; ++l) {
        if (l < m) continue;
        moment[moment_index(l, m)] = moment[moment_index(l, m)] + term * p[moment_index(l, m)];
      }
    }
    moment[AUREOLE] = moment[AUREOLE] + READ(light, at + (DEGREE + 1) * GROUPS) * weight;
  }
  // Under a high sun what is divided is rounding, once sin^m falls below a float's digits: nothing is left of
  // it by adding to its square.
  const Real rounding = 1e-11;
  Real square = 1.0 - mu_s * mu_s;
  Real power = 1.0;
  UNROLL for (int m = 0; m <= DEGREE; ++m) {
    UNROLL for (int l = 0; l <= DEGREE; ++l) {
      if (l < m) continue;
      moment[moment_index(l, m)] = moment[moment_index(l, m)] * (harmonic_norm(l, m) / (power + rounding));
    }
    power *= square;
  }

  keep(i, s, g, moment);
  if (i == 0) keep_irradiance(s, g, irradiance);
}
