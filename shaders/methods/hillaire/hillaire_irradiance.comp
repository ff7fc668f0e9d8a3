#version 450
#extension GL_GOOGLE_include_directive : require
// The sky's irradiance on the ground under a sun, and with it the light of all further orders in the air: an
// invocation is a sun, and adds some of the directions above the ground.
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/second_order.glsl"

layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer parts;
// Of a sun twice GROUPS: sums over directions of the sky's radiance, and of what a unit of the ground's
// diffuse radiance adds to it; in the end the ground's diffuse radiance, and the logarithm of the irradiance.
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer suns;

layout(push_constant) uniform Push {
  int first;  // sun
  int end;
  int first_direction;
  int end_direction;
  int directions;
  int samples;
  int terms;  // of the series of orders two and up; 0 leaves them out
  float scale_height_km;
} push;

// Orders two and up at a point, bilinear: `part` 0 for a black ground, 2 for a unit of its radiance.
Vec4 interpolated_part(NodePosition sun, NodePosition altitude, int part, int group) {
  int low = (3 * (altitude.node * MULTIPLE_SUNS + sun.node) + part) * GROUPS + group;
  int high = low + 3 * MULTIPLE_SUNS * GROUPS;
  int next = 3 * GROUPS;
  return mix(mix(READ(parts, low), READ(parts, low + next), sun.fraction),
             mix(READ(parts, high), READ(parts, high + next), sun.fraction), altitude.fraction);
}

void add_sky(SunlitRay ray, ScatteringAngle angle, INOUT_ARRAY(Vec4, radiance, GROUPS),
             INOUT_ARRAY(Vec4, coupled, GROUPS)) {
  Real column[MEDIA_SIZE];
  Vec4 density[MEDIA_SIZE];
  Vec4 column_to[MEDIA_SIZE];
  Vec4 light[GROUPS];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  scattering_towards(angle, scattering_phase);
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  Panels panels = panels_along(ray, shadow_over(ray), push.samples, push.scale_height_km);
  int count = number_of(panels);
  for (int p = 0; p < count; ++p) {
    Panel panel = panel_of(panels, p);
    pass_panel(ray, panel, column, density, column_to);
    for (int i = 0; i < 4; ++i) {
      Node node = node_of(ray, panel, i);
      NodePosition sun = node_position(table_sun_coordinate(node.mu_sun), MULTIPLE_SUNS);
      NodePosition altitude =
          node_position(table_altitude_coordinate(node.altitude_km), MULTIPLE_ALTITUDES);
      transmittance_to_sun(node.altitude_km, node.mu_sun, light);
      UNROLL for (int g = 0; g < GROUPS; ++g) {
        Vec4 seen = seen_width(node, column_to, i, g);
        Vec4 once = Vec4(0.0);
        Vec4 scattered = Vec4(0.0);
        UNROLL for (int c = 0; c < MEDIA; ++c) {
          once = once + scattering_phase[c * GROUPS_SIZE + g] * density[c][i];
          scattered = scattered + scattering(c, g) * density[c][i];
        }
        if (panel.lit) radiance[g] = radiance[g] + once * light[g] * seen;
        if (push.terms == 0) continue;
        scattered = scattered * seen;
        radiance[g] = radiance[g] + scattered * interpolated_part(sun, altitude, 0, g);
        coupled[g] = coupled[g] + scattered * interpolated_part(sun, altitude, 2, g);
      }
    }
  }
}

void main() {
  load_scene();
  load_media();
  int node = push.first + int(gl_GlobalInvocationID.x);
  if (node >= push.end) return;
  take_out_forward_peak();
  Real mu_sun = sun_cosine_at(Real(node) / Real(MULTIPLE_SUNS - 1));
  Vec3 to_sun = Vec3(sqrt(1.0 - mu_sun * mu_sun), 0.0, mu_sun);
  Vec4 radiance[GROUPS];
  Vec4 coupled[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    bool fresh = push.first_direction == 0;
    radiance[g] = fresh ? Vec4(0.0) : READ(suns, 2 * node * GROUPS + g);
    coupled[g] = fresh ? Vec4(0.0) : READ(suns, (2 * node + 1) * GROUPS + g);
  }
  for (int i = push.first_direction; i < push.end_direction; ++i) {
    Real mu = lattice_cosine_above(i, push.directions);
    Real azimuth = lattice_azimuth(i);
    Real sine = sqrt(1.0 - mu * mu);
    Vec3 direction = Vec3(sine * cos(azimuth), sine * sin(azimuth), mu);
    add_sky(sunlit_ray(0.0, mu, false, mu_sun, dot(direction, to_sun)),
            scattering_angle(to_sun, direction), radiance, coupled);
  }
  bool done = push.end_direction == push.directions;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (done) {
      // Directions are in proportion to their cosine: the irradiance is PI times the mean. The ground's
      // own light comes back to it: E = E0 + E1 (albedo / PI) E.
      Real mean = PI / Real(push.directions);
      Vec4 irradiance =
          radiance[g] * mean / (1.0 - lambertian(g) * coupled[g] * mean);
      radiance[g] = lambertian(g) * irradiance;
      coupled[g] = log(max(irradiance, Vec4(1e-30)));
    }
    WRITE(suns, 2 * node * GROUPS + g, radiance[g]);
    WRITE(suns, (2 * node + 1) * GROUPS + g, coupled[g]);
  }
}
