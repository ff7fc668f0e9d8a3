#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// Light of the next order that comes down the rays: one invocation a ray, a sun and a group.

// A ray under a sun.
struct Beam {
  TableRay ray;
  Real mu_s;
  Real nu;     // cosine to the axis a quarter of a turn from it
  Real sines;
};

Real nu_at(Beam beam, Real x) { return beam.nu + beam.sines * x; }

// Cosine of the axis' zenith angle at a distance and an altitude.
Real axis_at(Beam beam, Real x, Vec4 place) {
  return axis_after(beam.ray.altitude_km, beam.mu_s, nu_at(beam, x), place.z, place.x);
}

Real node_of_axis(Real axis, Vec4 suns) {
  return max((inverse_sinh((axis + suns.x) / push.grid.sun_width) - suns.y) * suns.z, 0.0);
}

// What a node sends, as a series in azimuth, from its rows about the sun's node `at`.
void sent(int row, Real at, OUT_ARRAY(Vec4, term, SERIES)) {
  CubicTaps taps = cubic_taps(at, push.grid.suns);
  Vec4 logarithm[4];
  UNROLL for (int m = 0; m <= DEGREE; ++m) term[m] = Vec4(0.0);
  UNROLL for (int tap = 0; tap < 4; ++tap) {
    int own = row + (taps.first + tap) * ROW_SLOTS * GROUPS;
    UNROLL for (int m = 0; m <= DEGREE; m += 2) {
      uvec4 pair = READ(rows, own + m / 2 * GROUPS);
      term[m] = term[m] + first_of(pair) * taps.weights[tap];
      if (m < DEGREE) term[min(m + 1, DEGREE)] = term[min(m + 1, DEGREE)] + second_of(pair) * taps.weights[tap];
    }
    logarithm[tap] = uintBitsToFloat(READ(rows, own + (ROW_SLOTS - 1) * GROUPS));
  }
  Vec4 light = exp(limited_sum(logarithm, taps));
  UNROLL for (int m = 0; m <= DEGREE; ++m) term[m] = term[m] * light;
}

Vec4 towards(Beam beam, Real x, Vec4 place, ARRAY(Vec4, term, SERIES)) {
  Real c[MOST_DEGREE + 1];
  azimuth_terms(place.y, axis_at(beam, x, place), nu_at(beam, x), DEGREE, c);
  Vec4 sum = Vec4(0.0);
  UNROLL for (int m = 0; m <= DEGREE; ++m) sum = sum + term[m] * c[m];
  return sum;
}

// A node's light at all azimuths from a few.
void add_from_few(Beam beam, Vec4 place, Vec4 suns, int row, AzimuthRule rule,
                  INOUT_ARRAY(Vec4, radiance, AZIMUTHS)) {
  Vec4 mean[SERIES];
  Vec4 slope[SERIES];
  Vec4 bend[SERIES];
  UNROLL for (int m = 0; m <= DEGREE; ++m) {
    mean[m] = Vec4(0.0);
    slope[m] = Vec4(0.0);
    bend[m] = Vec4(0.0);
  }
  for (int p = 0; p < rule.points + rule.more; ++p) {
    AzimuthSample point = azimuth_sample(rule, p);
    Vec4 term[SERIES];
    sent(row, node_of_axis(axis_at(beam, point.x, place), suns), term);
    UNROLL for (int m = 0; m <= DEGREE; ++m) {
      mean[m] = mean[m] + term[m] * point.shares.x;
      slope[m] = slope[m] + term[m] * point.shares.y;
      bend[m] = bend[m] + term[m] * point.shares.z;
    }
  }
  UNROLL for (int a = 0; a < AZIMUTHS; ++a) {
    Real x = cos(table_azimuth(a));
    Vec4 term[SERIES];
    UNROLL for (int m = 0; m <= DEGREE; ++m) term[m] = chebyshev_sum(mean[m], slope[m], bend[m], x);
    radiance[a] = radiance[a] + max(towards(beam, x, place, term), Vec4(0.0));
  }
}

void add_azimuth(Beam beam, Real x, Vec4 radiance, INOUT_ARRAY(Vec4, terms, LIGHT_SLOTS)) {
  Real nu = nu_at(beam, x);
  Real c[MOST_DEGREE + 1];
  azimuth_terms(beam.ray.mu, beam.mu_s, nu, DEGREE, c);
  Real p[MOST_TERMS];
  legendre_polynomials(nu, DEGREE + 1, p);
  UNROLL for (int m = 0; m <= DEGREE; ++m) terms[m] = terms[m] + radiance * c[m];
  terms[DEGREE + 1] = terms[DEGREE + 1] + radiance * p[SERIES];
}

// Diffuse irradiance of the ground at the ray's end.
Vec4 irradiance_of(Beam beam, Real x, int g) {
  Real axis = axis_after(beam.ray.altitude_km, beam.mu_s, nu_at(beam, x), beam.ray.length_km, 0.0);
  CubicTaps taps = cubic_taps(node_of_sun(push.grid, sun_range(push.grid, 0.0), axis), push.grid.suns);
  int own = irradiance_at(push.grid.altitudes, taps.first) + g;
  Vec4 logarithm[4];
  UNROLL for (int tap = 0; tap < 4; ++tap) logarithm[tap] = READ(moments, own + tap * GROUPS);
  return exp(limited_sum(logarithm, taps));
}

void main() {
  load_scene();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int j = index / GROUPS / push.grid.suns % RAYS;
  int i = push.first_altitude + index / GROUPS / push.grid.suns / RAYS;
  Beam beam;
  beam.ray = table_ray(i, j);
  beam.mu_s = sun_of_node(push.grid, sun_range(push.grid, beam.ray.altitude_km), Real(s));
  beam.nu = beam.ray.mu * beam.mu_s;
  beam.sines = sqrt(max((1.0 - beam.ray.mu * beam.ray.mu) * (1.0 - beam.mu_s * beam.mu_s), 0.0));

  Vec4 radiance[AZIMUTHS];
  UNROLL for (int a = 0; a < AZIMUTHS; ++a) radiance[a] = Vec4(0.0);
  for (int k = 0; k < push.steps; ++k) {
    int node = node_at(i, j, k);
    Vec4 place = READ(ray_data, node);
    Vec4 suns = READ(ray_data, node + 1);
    Real spacings = abs(node_of_axis(axis_at(beam, 1.0, place), suns) -
                     node_of_axis(axis_at(beam, -1.0, place), suns));
    add_from_few(beam, place, suns, row_at(i, j, k, 0) + g, azimuth_rule(spacings), radiance);
  }

  Vec4 reflected = READ(ray_data, ground_at(i, j) + g);
  Vec4 terms[LIGHT_SLOTS];
  UNROLL for (int n = 0; n < LIGHT_SLOTS; ++n) terms[n] = Vec4(0.0);
  UNROLL for (int a = 0; a < AZIMUTHS; ++a) add_azimuth(beam, cos(table_azimuth(a)), radiance[a], terms);
  ROLLED for (int a = 0; a < (beam.ray.down ? AZIMUTHS : 0); ++a) {
    Real x = cos(table_azimuth(a));
    add_azimuth(beam, x, reflected * irradiance_of(beam, x, g), terms);
  }
  int at = light_at(i, j, s) + g;
  UNROLL for (int n = 0; n < LIGHT_SLOTS; ++n) WRITE(light, at + n * GROUPS, terms[n]);
}
