#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

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
#define scattering_towards series_towards
#include "methods/raymarch.glsl"

// Nodes on each smooth piece: the shadow's edge cuts rays, so pieces are short.
#define PIECE_NODES 6

// Light of order one, and of the sunlit ground, that comes down the rays: one invocation a ray and a sun.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
  load_media();
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
    Vec4 ground[GROUPS];
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      inscatter[g] = Vec4(0.0);
      ground[g] = Vec4(0.0);
    }
    Real from_km = 0.0;
    march_towards(path, 0, PIECE_NODES, MOST_PIECES, from_km, inscatter);
    light_ground_from(path, 0, ground);

    Real nu = dot(axis, path.direction);
    Real c[MOST_DEGREE + 1];
    azimuth_terms(ray.mu, mu_s, nu, DEGREE, c);
    Real p[MOST_TERMS];
    legendre_polynomials(nu, DEGREE + 1, p);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      // What the ground reflects is dimmed by the view as it counts here: lambertian() is in both.
      Vec4 seen = ray_data[ground_at(i, j) + g] / max(lambertian(g), Vec4(1e-30));
      Vec4 radiance = inscatter[g] + ground[g] * seen;
      UNROLL for (int m = 0; m <= DEGREE; ++m) terms[m * GROUPS + g] = terms[m * GROUPS + g] + radiance * c[m];
      terms[(DEGREE + 1) * GROUPS + g] = terms[(DEGREE + 1) * GROUPS + g] + radiance * p[DEGREE + 1];
    }
  }
  UNROLL for (int n = 0; n < ROW_SLOTS * GROUPS; ++n) light[at + n] = terms[n];
}
