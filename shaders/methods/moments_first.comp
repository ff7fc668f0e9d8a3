#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

Real view_share[MEDIA_SIZE];

// A peaked phase function as a series that the tables' few directions can integrate.
void series_towards(ScatteringAngle angle, OUT_ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE)) {
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    int kind = medium(c).phase;
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 phase = Vec4(0.0);
      if (kind == PHASE_RAYLEIGH) phase = rayleigh_phase(depolarisation(c, g), angle.cosine);
      if (kind > PHASE_RAYLEIGH) {
        Real before = 0.0;
        Real p = 1.0;
        for (int l = 0; l < TERMS; ++l) {
          phase = phase + series(c, l, g) * p;
          Real next = (Real(2 * l + 1) * angle.cosine * p - Real(l) * before) / Real(l + 1);
          before = p;
          p = next;
        }
      }
      scattering_phase[c * GROUPS + g] = scattering(c, g) * phase;
    }
  }
}

// Adds the columns between two shares of a way, by a three-point rule.
void add_columns(TableRay ray, Cuts cuts, Real from, Real to, INOUT_ARRAY(Real, column, MEDIA_SIZE)) {
  UNROLL for (int i = 0; i < 3; ++i) {
    RayNode node = ray_node(cuts, from + (to - from) * gauss3_node(i), gauss3_weight(i) * (to - from));
    Real h = altitude_after(ray.altitude_km, ray.mu, node.t_km);
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] += node.width_km * relative_density(h, c);
  }
}

// Adds what a lit part of the ray scatters towards its start, by a Gauss rule. `column` is that up to `from_km`, and in the end up to `to_km`.
void add_lit_part(TableRay ray, Path path, Real from_km, Real to_km, INOUT_ARRAY(Real, column, MEDIA_SIZE),
                  INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Cuts cuts = part_of(cuts_of(ray.altitude_km, ray.mu, ray.length_km), from_km, to_km);
  Real density[MEDIA_SIZE];
  Real together[MEDIA_SIZE];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  if (!NEAR_SUN) {
    series_towards(scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction),
                   scattering_phase);
  }
  Real last = 0.0;
  for (int k = 0; k < push.first_steps; ++k) {
    Vec2 rule = gauss_node(push.first_steps, k);
    RayNode node = ray_node(cuts, rule.x, rule.y);
    add_columns(ray, cuts, last, rule.x, column);
    last = rule.x;
    Real h = altitude_after(ray.altitude_km, ray.mu, node.t_km);
    Vec3 position = path.start + path.direction * node.t_km;
    SunRay sun = sun_ray(position, Vec3(0.0));
    Real mu_sun = max(dot(position, sun.direction) / length(position), horizon_cosine(h));
    densities(h, density);
    columns_to_top(h, mu_sun, together);
    UNROLL for (int c = 0; c < MEDIA; ++c) together[c] += view_share[c] * column[c];
    if (NEAR_SUN) series_towards(scattering_angle(sun.direction, path.direction), scattering_phase);
    add_scattered(together, density, scattering_phase, node.width_km * sun.irradiance, 0, inscatter);
  }
  add_columns(ray, cuts, last, 1.0, column);
}

// Light of order one that comes down a ray.
void trace_first(TableRay ray, Path path, INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Shadow shadow = shadow_on(path, light_of_sun(0), 0.0);
  Real column[MEDIA_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  bool dark = shadow.leave_km > shadow.enter_km;
  for (int part = 0; part < 2; ++part) {
    Real from_km = part == 0 ? 0.0 : shadow.leave_km;
    Real to_km = dark && part == 0 ? shadow.enter_km : ray.length_km;
    if (part == 1 && !dark || to_km - from_km <= 1e-6 * ray.length_km) continue;
    if (part == 1) columns_along(ray.altitude_km, ray.mu, from_km, column);
    add_lit_part(ray, path, from_km, to_km, column, inscatter);
  }
}

// Radiance of the sunlit ground at the ray's end, as it is seen from its start.
Vec4 sunlit_ground(int i, int j, int g, ARRAY(Real, column, MEDIA_SIZE), Real irradiance) {
  return ray_data[ground_at(i, j) + g] * transmittance_of(column, g) * irradiance;
}

// Light of order one, and of the sunlit ground, that comes down the rays: one invocation a ray and a sun.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
  load_media();
  UNROLL for (int c = 0; c < MEDIA; ++c) view_share[c] = VIEW_SHARE(c);
  int s = index % push.grid.suns;
  int j = index / push.grid.suns % RAYS;
  int i = index / push.grid.suns / RAYS;
  TableRay ray = table_ray(i, j);
  Real mu_s = sun_of_node(push.grid, sun_range(push.grid, ray.altitude_km), Real(s));
  Vec3 axis = Vec3(sqrt(1.0 - mu_s * mu_s), 0.0, mu_s);
  scene.sun_direction = Vec4(axis, 0.0);
  scene.sun_position = Vec4(axis * scene.sun_distance_km, 0.0);

  Vec4 terms[ROW_SLOTS * GROUPS];
  int at = light_at(i, j, s);
  UNROLL for (int n = 0; n < ROW_SLOTS * GROUPS; ++n) {
    terms[n] = push.first_azimuth > 0 ? light[at + n] : Vec4(0.0);
  }
  Path path;
  path.start = Vec3(0.0, 0.0, scene.planet_radius_km + ray.altitude_km);
  path.altitude_km = ray.altitude_km;
  path.mu = ray.mu;
  path.length_km = ray.length_km;
  path.meets_ground = ray.down;
  for (int a = push.first_azimuth; a < push.end_azimuth; ++a) {
    Real azimuth = table_azimuth(a);
    Real sine = sqrt(max(1.0 - ray.mu * ray.mu, 0.0));
    path.direction = Vec3(sine * cos(azimuth), sine * sin(azimuth), ray.mu);
    Vec4 inscatter[GROUPS];
    UNROLL for (int g = 0; g < GROUPS; ++g) inscatter[g] = Vec4(0.0);
    trace_first(ray, path, inscatter);
    if (ray.down) {
      Vec3 position = path.start + path.direction * ray.length_km;
      SunRay sun = sun_ray(position, Vec3(0.0));
      Real mu_sun = dot(position, sun.direction) / length(position);
      Real column[MEDIA_SIZE];
      if (mu_sun > 0.0) {
        columns_to_top(0.0, mu_sun, column);
        UNROLL for (int g = 0; g < GROUPS; ++g) {
          inscatter[g] = inscatter[g] + sunlit_ground(i, j, g, column, mu_sun * sun.irradiance);
        }
      }
    }

    Real nu = dot(axis, path.direction);
    Real c[MOST_DEGREE + 1];
    azimuth_terms(ray.mu, mu_s, nu, DEGREE, c);
    Real p[MOST_TERMS];
    legendre_polynomials(nu, DEGREE + 1, p);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 radiance = inscatter[g];
      UNROLL for (int m = 0; m <= DEGREE; ++m) terms[m * GROUPS + g] = terms[m * GROUPS + g] + radiance * c[m];
      terms[(DEGREE + 1) * GROUPS + g] = terms[(DEGREE + 1) * GROUPS + g] + radiance * p[DEGREE + 1];
    }
  }
  UNROLL for (int n = 0; n < ROW_SLOTS * GROUPS; ++n) light[at + n] = terms[n];
}
