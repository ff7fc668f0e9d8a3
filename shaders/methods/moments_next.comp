#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// Light of the next order that comes down the rays: one invocation a ray, a sun and a group.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int j = index / GROUPS / push.grid.suns % RAYS;
  int i = push.first_altitude + index / GROUPS / push.grid.suns / RAYS;
  TableRay ray = table_ray(i, j);
  Real mu_s = sun_of_node(push.grid, sun_range(push.grid, ray.altitude_km), Real(s));
  SunRange on_ground = sun_range(push.grid, 0.0);
  Vec4 reflected = ray_data[ground_at(i, j) + g];
  int own = irradiance_at(push.grid.altitudes, 0) + g;
  int row_step = ROW_SLOTS * GROUPS;
  Real sines = sqrt(max((1.0 - ray.mu * ray.mu) * (1.0 - mu_s * mu_s), 0.0));

  Vec4 terms[ROW_SLOTS];
  UNROLL for (int n = 0; n < ROW_SLOTS; ++n) terms[n] = Vec4(0.0);
  for (int a = 0; a < push.azimuths; ++a) {
    Real nu = ray.mu * mu_s + sines * cos(table_azimuth(a));
    Vec4 radiance = Vec4(0.0);
    for (int k = 0; k < push.steps; ++k) {
      int node = node_at(i, j, k);
      Vec4 place = ray_data[node];
      Vec4 suns = ray_data[node + 1];
      Real here = axis_after(ray.altitude_km, mu_s, nu, place.z, place.x);
      Real u = inverse_sinh((here + suns.x) / push.grid.sun_width);
      CubicTaps taps = cubic_taps(max((u - suns.y) * suns.z, 0.0), push.grid.suns);
      Real c[MOST_DEGREE + 1];
      azimuth_terms(place.y, here, nu, DEGREE, c);
      int row = row_at(i, j, k, taps.first) + g;
      Vec4 ratio[4];
      Vec4 logarithm[4];
      UNROLL for (int tap = 0; tap < 4; ++tap) {
        ratio[tap] = Vec4(0.0);
        UNROLL for (int m = 0; m <= DEGREE; ++m) ratio[tap] = ratio[tap] + rows[row + m * GROUPS] * c[m];
        logarithm[tap] = rows[row + (DEGREE + 1) * GROUPS];
        row += row_step;
      }
      radiance = radiance + cubic_sum(ratio, taps) * exp(limited_sum(logarithm, taps));
    }
    if (ray.down) {
      Real here = axis_after(ray.altitude_km, mu_s, nu, ray.length_km, 0.0);
      CubicTaps taps = cubic_taps(node_of_sun(push.grid, on_ground, here), push.grid.suns);
      Vec4 logarithm[4];
      UNROLL for (int tap = 0; tap < 4; ++tap) logarithm[tap] = moments[own + (taps.first + tap) * GROUPS];
      radiance = radiance + reflected * exp(limited_sum(logarithm, taps));
    }
    Real c[MOST_DEGREE + 1];
    azimuth_terms(ray.mu, mu_s, nu, DEGREE, c);
    Real p[MOST_TERMS];
    legendre_polynomials(nu, DEGREE + 1, p);
    UNROLL for (int m = 0; m <= DEGREE; ++m) terms[m] = terms[m] + radiance * c[m];
    terms[DEGREE + 1] = terms[DEGREE + 1] + radiance * p[DEGREE + 1];
  }
  int at = light_at(i, j, s) + g;
  UNROLL for (int n = 0; n < ROW_SLOTS; ++n) light[at + n * GROUPS] = terms[n];
}
