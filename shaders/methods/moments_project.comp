#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// What the orders after this one add to it, over it.
Vec4 beyond(int at, Vec4 lowest) {
  return push.tail != 0 ? geometric_tail(exp(moments[at]), lowest) : Vec4(0.0);
}

// Adds an order to the sum; leaves the order, or in the end the sum, as it is read.
void keep(int at, Vec4 moment[SLOTS]) {
  Vec4 share = 1.0 + beyond(at, moment[0]);
  UNROLL for (int n = 0; n < SLOTS; ++n) {
    int sum = sum_table() + at + n * GROUPS;
    Vec4 total = moments[sum] + moment[n] * share;
    moments[sum] = total;
    if (push.last != 0) moment[n] = total;
  }
  moments[at] = moment_logarithm(moment[0]);
  UNROLL for (int n = 1; n < SLOTS; ++n) moments[at + n * GROUPS] = moment_ratio(moment[n], moment[0]);
}

void keep_irradiance(int at, Vec4 irradiance) {
  Vec4 total = moments[sum_table() + at] + irradiance * (1.0 + beyond(at, irradiance));
  moments[sum_table() + at] = total;
  moments[at] = moment_logarithm(push.last != 0 ? total : irradiance);
}

// The moments of the light that the rays bring, of one order: one invocation an altitude, a sun and a
// group of wavelengths.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
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
    Real weight = ray.weight * 2.0 * PI / Real(push.azimuths);
    Real p[MOST_MOMENTS];
    zenith_polynomials(ray.mu, DEGREE, p);
    int at = light_at(i, j, s) + g;
    UNROLL for (int m = 0; m <= DEGREE; ++m) {
      Vec4 term = light[at + m * GROUPS] * weight;
      if (m == 0 && !ray.down) irradiance = irradiance + term * ray.mu;
      UNROLL for (int l = m; l <= DEGREE; ++l) {
        moment[moment_index(l, m)] = moment[moment_index(l, m)] + term * p[moment_index(l, m)];
      }
    }
    moment[AUREOLE] = moment[AUREOLE] + light[at + (DEGREE + 1) * GROUPS] * weight;
  }
  Real square = 1.0 - mu_s * mu_s;
  Real power = 1.0;
  UNROLL for (int m = 0; m <= DEGREE; ++m) {
    UNROLL for (int l = m; l <= DEGREE; ++l) {
      moment[moment_index(l, m)] = moment[moment_index(l, m)] * (harmonic_norm(l, m) / power);
    }
    power *= square;
  }

  keep(moment_at(i, s, 0) + g, moment);
  if (i == 0) keep_irradiance(irradiance_at(push.grid.altitudes, s) + g, irradiance);
}
