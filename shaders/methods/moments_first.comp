#version 450
#extension GL_GOOGLE_include_directive : require
#define COLUMN_NODES 4
#include "methods/moments_device.glsl"

const int GROUND_PART = MEDIA_GROUPS_SIZE;
const int PARTS = MEDIA_GROUPS_SIZE + GROUPS;  // of a ray's light: by constituent, and the ground's
const int LIGHT_SIZE = LIGHT_SLOTS * GROUPS;

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
        ROLLED for (int l = 0; l < TERMS; ++l) {
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

// Adds the columns between two shares of a way, by a two-point rule.
void add_columns(TableRay ray, Cuts cuts, Real from, Real to, INOUT_ARRAY(Real, column, MEDIA_SIZE)) {
  UNROLL for (int i = 0; i < 2; ++i) {
    RayNode node = ray_node(cuts, from + (to - from) * gauss2_node(i), 0.5 * (to - from));
    Real h = altitude_after(ray.altitude_km, ray.mu, node.t_km);
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] += node.width_km * relative_density(h, c);
  }
}

// What a lit part of the ray sends to its start, by a Gauss rule, the phase functions left out where the
// light is parallel: they are the same all along it. `column` is that up to `from_km`, and in the end up to
// `to_km`.
void add_lit_part(TableRay ray, Path path, Real from_km, Real to_km, INOUT_ARRAY(Real, column, MEDIA_SIZE),
                  INOUT_ARRAY(Vec4, parts, PARTS)) {
  Cuts cuts = part_of(cuts_of(ray.altitude_km, ray.mu, ray.length_km), from_km, to_km);
  Real density[MEDIA_SIZE];
  Real together[MEDIA_SIZE];
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
    Vec4 phase[MEDIA_GROUPS_SIZE];
    if (NEAR_SUN) series_towards(scattering_angle(sun.direction, path.direction), phase);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 here = transmittance_of(together, g) * (node.width_km * sun.irradiance);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        Vec4 sent = here * density[c];
        if (NEAR_SUN) sent = sent * phase[c * GROUPS + g];
        parts[c * GROUPS + g] = parts[c * GROUPS + g] + sent;
      }
    }
  }
  add_columns(ray, cuts, last, 1.0, column);
}

// Radiance of the sunlit ground at the ray's end, as it is seen from its start.
void add_sunlit_ground(int i, int j, Path path, INOUT_ARRAY(Vec4, parts, PARTS)) {
  Vec3 position = path.start + path.direction * path.length_km;
  SunRay sun = sun_ray(position, Vec3(0.0));
  Real mu_sun = dot(position, sun.direction) / length(position);
  if (mu_sun <= 0.0) return;
  Real column[MEDIA_SIZE];
  columns_to_top(0.0, mu_sun, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    parts[GROUND_PART + g] =
        READ(ray_data, ground_at(i, j) + g) * transmittance_of(column, g) * (mu_sun * sun.irradiance);
  }
}

// What the whole ray sends to its start. @pre parts are 0
void trace_first(int i, int j, TableRay ray, Path path, INOUT_ARRAY(Vec4, parts, PARTS)) {
  Shadow shadow = shadow_on(path, light_of_sun(0), 0.0);
  Real column[MEDIA_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  bool dark = shadow.leave_km > shadow.enter_km;
  for (int part = 0; part < 2; ++part) {
    Real from_km = part == 0 ? 0.0 : shadow.leave_km;
    Real to_km = dark && part == 0 ? shadow.enter_km : ray.length_km;
    if (part == 1 && !dark || to_km - from_km <= 1e-6 * ray.length_km) continue;
    if (part == 1) columns_along(ray.altitude_km, ray.mu, from_km, column);
    add_lit_part(ray, path, from_km, to_km, column, parts);
  }
  if (ray.down) add_sunlit_ground(i, j, path, parts);
}

Path path_towards(TableRay ray, Real cosine) {
  Path path;
  path.start = Vec3(0.0, 0.0, scene.planet_radius_km + ray.altitude_km);
  path.altitude_km = ray.altitude_km;
  path.mu = ray.mu;
  path.length_km = ray.length_km;
  path.meets_ground = ray.down;
  Real sine = sqrt(max(1.0 - ray.mu * ray.mu, 0.0));
  path.direction = Vec3(sine * cosine, sine * sqrt(1.0 - cosine * cosine), ray.mu);
  return path;
}

// Spacings of the sun's nodes between its azimuths 0 and pi, at the ray's end.
Real spacings_of(TableRay ray, Real mu_s) {
  Real altitude = ray.down ? 0.0 : scene.thickness_km;
  SunRange range = sun_range(push.grid, altitude);
  Real sines = sqrt(max((1.0 - ray.mu * ray.mu) * (1.0 - mu_s * mu_s), 0.0));
  Real end = ray.mu * mu_s;
  Real near = node_of_sun(push.grid, range,
                          axis_after(ray.altitude_km, mu_s, end - sines, ray.length_km, altitude));
  Real far = node_of_sun(push.grid, range,
                         axis_after(ray.altitude_km, mu_s, end + sines, ray.length_km, altitude));
  return far - near;
}

void add_azimuth(Vec3 axis, Path path, ARRAY(Vec4, parts, PARTS), INOUT_ARRAY(Vec4, terms, LIGHT_SIZE)) {
  Vec4 phase[MEDIA_GROUPS_SIZE];
  if (!NEAR_SUN) series_towards(scattering_angle(axis, path.direction), phase);
  Real nu = dot(axis, path.direction);
  Real c[MOST_DEGREE + 1];
  azimuth_terms(path.mu, axis.z, nu, DEGREE, c);
  Real p[MOST_TERMS];
  legendre_polynomials(nu, DEGREE + 1, p);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 radiance = parts[GROUND_PART + g];
    UNROLL for (int m = 0; m < MEDIA; ++m) {
      Vec4 scattered = parts[m * GROUPS + g];
      if (!NEAR_SUN) scattered = scattered * phase[m * GROUPS + g];
      radiance = radiance + scattered;
    }
    UNROLL for (int m = 0; m <= DEGREE; ++m) terms[m * GROUPS + g] = terms[m * GROUPS + g] + radiance * c[m];
    terms[(DEGREE + 1) * GROUPS + g] = terms[(DEGREE + 1) * GROUPS + g] + radiance * p[DEGREE + 1];
  }
}

// A series over the cosine of the azimuth, from one to three azimuths: but for the phase functions light
// changes little between them.
Vec4 mean[PARTS];
Vec4 slope[PARTS];
Vec4 bend[PARTS];

void clear_series() {
  UNROLL for (int n = 0; n < PARTS; ++n) {
    mean[n] = Vec4(0.0);
    slope[n] = Vec4(0.0);
    bend[n] = Vec4(0.0);
  }
}

void add_to_series(ARRAY(Vec4, parts, PARTS), Vec3 shares) {
  UNROLL for (int n = 0; n < PARTS; ++n) {
    mean[n] = mean[n] + parts[n] * shares.x;
    slope[n] = slope[n] + parts[n] * shares.y;
    bend[n] = bend[n] + parts[n] * shares.z;
  }
}

void mix_with_series(Real x, Real share, INOUT_ARRAY(Vec4, parts, PARTS)) {
  UNROLL for (int n = 0; n < PARTS; ++n) {
    Vec4 of_few = max(chebyshev_sum(mean[n], slope[n], bend[n], x), Vec4(0.0));
    parts[n] = parts[n] * (1.0 - share) + of_few * share;
  }
}

// Adds the azimuths of this dispatch: what their own rays see, what the series of a few has, or a share of
// either. In one loop, for the code that traces a ray is long, and drivers copy it to each place that calls it;
// loops of one round are passed over where their condition does not hold, which both sides of an if are not.
void add_azimuths(int i, int j, TableRay ray, Vec3 axis, INOUT_ARRAY(Vec4, terms, LIGHT_SIZE)) {
  Real spacings = spacings_of(ray, axis.z);
  AzimuthRule rule = azimuth_rule(spacings);
  Real each = push.each_azimuth != 0 ? 1.0 : share_of_each_azimuth(spacings);
  int few = each < 1.0 ? rule.points + rule.more : 0;
  clear_series();
  for (int n = 0; n < few + push.end_azimuth - push.first_azimuth; ++n) {
    bool of_few = n < few;
    AzimuthSample point = azimuth_sample(rule, of_few ? n : 0);
    Real x = of_few ? point.x : cos(table_azimuth(push.first_azimuth + n - few));
    Path path = path_towards(ray, x);
    Vec4 parts[PARTS];
    UNROLL for (int k = 0; k < PARTS; ++k) parts[k] = Vec4(0.0);
    for (int once = 0; once < (of_few || each > 0.0 ? 1 : 0); ++once) trace_first(i, j, ray, path, parts);
    add_to_series(parts, of_few ? point.shares : Vec3(0.0));
    for (int once = 0; once < (of_few ? 0 : 1); ++once) {
      mix_with_series(x, 1.0 - each, parts);
      add_azimuth(axis, path, parts, terms);
    }
  }
}

// Light of order one, and of the sunlit ground, that comes down the rays: one invocation a ray and a sun.
void main() {
  load_scene();
  load_media();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  UNROLL for (int c = 0; c < MEDIA; ++c) view_share[c] = share_of_extinction(c);
  int s = index % push.grid.suns;
  int j = index / push.grid.suns % RAYS;
  int i = index / push.grid.suns / RAYS;
  TableRay ray = table_ray(i, j);
  Real mu_s = sun_of_node(push.grid, sun_range(push.grid, ray.altitude_km), Real(s));
  Vec3 axis = Vec3(sqrt(1.0 - mu_s * mu_s), 0.0, mu_s);
  scene.sun_direction = Vec4(axis, 0.0);
  scene.sun_position = Vec4(axis * scene.sun_distance_km, 0.0);

  Vec4 terms[LIGHT_SIZE];
  int at = light_at(i, j, s);
  UNROLL for (int n = 0; n < LIGHT_SIZE; ++n) {
    terms[n] = push.first_azimuth > 0 ? READ(light, at + n) : Vec4(0.0);
  }
  add_azimuths(i, j, ray, axis, terms);
  UNROLL for (int n = 0; n < LIGHT_SIZE; ++n) WRITE(light, at + n, terms[n]);
}
