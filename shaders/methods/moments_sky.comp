#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_view.glsl"

// Light that was scattered more than once, as a camera sees it: one invocation a direction and a group.
// Kept are the logarithm of what the moments give, and over it what the aureole's function multiplies.
layout(std430, binding = OWN + 2) restrict writeonly buffer SkyBuffer { Vec4 sky[]; };

layout(push_constant) uniform Push {
  MomentGrid grid;
  int fine_altitudes, fine_suns;
  int elevations, azimuths;   // of the sky; the ground has as many
  int steps;
  int first, end;
} push;

Vec4 dimmed(ARRAY(Real, column, MEDIA_SIZE), int g) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + spectra[(2 + 3 * c) * GROUPS + g] * column[c];
  return exp(-depth);
}

// A value between four nodes of the table.
Vec4 between(int at, int to_sun, int to_altitude, Vec2 x) {
  return mix(mix(moments[at], moments[at + to_sun], x.x),
             mix(moments[at + to_altitude], moments[at + to_altitude + to_sun], x.x), x.y);
}

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
  load_media();
  int g = index % GROUPS;
  int a = index / GROUPS % push.azimuths;
  int e = index / GROUPS / push.azimuths;
  bool ground = e >= push.elevations;
  Real share = Real(ground ? e - push.elevations : e) / Real(push.elevations - 1);
  Vec3 axis = sun_axis();
  Vec3 direction = direction_of_share(max(share, 2e-3), ground, PI * Real(a) / Real(push.azimuths - 1),
                                      axis_forward(axis));
  Path path = path_from_camera(direction);
  // At the horizon itself rounding doesn't decide.
  path.meets_ground = ground;
  path.length_km = ground ? distance_to_ground(path.altitude_km, path.mu)
                          : distance_to_top(path.altitude_km, path.mu);
  Cuts cuts = cuts_of(path.altitude_km, path.mu, path.length_km);
  Real nu = dot(axis, direction);
  Real mu_s = dot(path.start, axis) / length(path.start);

  Vec4 smooth_light = Vec4(0.0);
  Vec4 aureole_light = Vec4(0.0);
  Real column[MEDIA_SIZE];
  Real density[MEDIA_SIZE];
  for (int k = 0; k < push.steps; ++k) {
    Vec2 rule = gauss_node(push.steps, k);
    RayNode node = ray_node(cuts, rule.x, rule.y);
    Real h = altitude_after(path.altitude_km, path.mu, node.t_km);
    Real mu = mu_after(path.altitude_km, path.mu, node.t_km, h);
    Real here = axis_after(path.altitude_km, mu_s, nu, node.t_km, h);
    columns_along(path.altitude_km, path.mu, node.t_km, column);
    densities(h, density);
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= share_of_extinction(c);
    Vec4 seen = dimmed(column, g) * node.width_km;

    Real altitude_node = node_of_altitude(push.grid, h) / Real(push.grid.altitudes - 1) *
                         Real(push.fine_altitudes - 1);
    Real sun_node = node_of_sun(push.grid, sun_range(push.grid, h), here) / Real(push.grid.suns - 1) *
                    Real(push.fine_suns - 1);
    int i = min(int(altitude_node), push.fine_altitudes - 2);
    int s = min(int(sun_node), push.fine_suns - 2);
    Vec2 x = Vec2(sun_node - Real(s), altitude_node - Real(i));
    int at = (i * push.fine_suns + s) * SLOTS * GROUPS + g;
    int to_sun = SLOTS * GROUPS;
    int to_altitude = push.fine_suns * to_sun;
    Vec4 lowest = exp(between(at, to_sun, to_altitude, x)) * seen;

    Real p[MOST_MOMENTS];
    zenith_polynomials(mu, DEGREE, p);
    Real terms[MOST_DEGREE + 1];
    azimuth_terms(mu, here, nu, DEGREE, terms);
    Vec4 source = Vec4(0.0);
    Vec4 peaked = Vec4(0.0);
    UNROLL for (int l = 0; l <= DEGREE; ++l) {
      if (!PARTICLES && l % 2 == 1) continue;
      Vec4 scattered = Vec4(0.0);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        Vec4 share_l = series(c, l, g) * (4.0 * PI / Real(2 * l + 1)) - peak(c, g);
        Vec4 coefficient = spectra[(3 + 3 * c) * GROUPS + g] * density[c];
        scattered = scattered + coefficient * share_l;
        if (l == 0 && medium(c).phase > PHASE_RAYLEIGH) peaked = peaked + coefficient;
      }
      Vec4 radiance = Vec4(0.0);
      UNROLL for (int m = 0; m <= l; ++m) {
        int n = moment_index(l, m);
        Vec4 ratio = Vec4(1.0);
        if (n > 0) ratio = between(at + n * GROUPS, to_sun, to_altitude, x);
        radiance = radiance + ratio * (p[n] * terms[m]);
      }
      source = source + scattered * radiance;
    }
    smooth_light = smooth_light + source * lowest;
    if (PARTICLES) {
      aureole_light =
          aureole_light + peaked * between(at + AUREOLE * GROUPS, to_sun, to_altitude, x) * lowest;
    }
  }
  int at = (e * push.azimuths + a) * 2 * GROUPS + g;
  sky[at] = moment_logarithm(smooth_light);
  sky[at + GROUPS] = moment_ratio(aureole_light, smooth_light);
}
