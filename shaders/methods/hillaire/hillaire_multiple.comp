#version 450
#extension GL_GOOGLE_include_directive : require
// Order two and what the series of further orders needs, at an altitude under a sun: an invocation is a
// texel, and adds some of the directions about it.
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/second_order.glsl"

// Of a texel three times GROUPS: sums over directions of what add_second_order gives; in the end order two
// with its series, and what a unit of the ground's diffuse radiance adds.
layout(binding = OWN + 2, rgba32f) uniform restrict imageBuffer parts;

layout(push_constant) uniform Push {
  int first;  // texel
  int end;
  int first_direction;
  int end_direction;
  int directions;
  int samples;
  int terms;  // of the series; below 0 all
  float scale_height_km;
} push;

void main() {
  load_scene();
  load_media();
  int texel = push.first + int(gl_GlobalInvocationID.x);
  if (texel >= push.end) return;
  take_out_forward_peak();
  Real h = altitude_at(Real(texel / MULTIPLE_SUNS) / Real(MULTIPLE_ALTITUDES - 1));
  Real mu_sun = sun_cosine_at(Real(texel % MULTIPLE_SUNS) / Real(MULTIPLE_SUNS - 1));
  Vec4 radiance[GROUPS];
  Vec4 lost[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    bool fresh = push.first_direction == 0;
    radiance[g] = fresh ? Vec4(0.0) : READ(parts, 3 * texel * GROUPS + g);
    lost[g] = fresh ? Vec4(0.0) : READ(parts, (3 * texel + 1) * GROUPS + g);
    ground[g] = fresh ? Vec4(0.0) : READ(parts, (3 * texel + 2) * GROUPS + g);
  }
  for (int i = push.first_direction; i < push.end_direction; ++i) {
    Real mu = lattice_cosine(i, push.directions);
    Real sines = sqrt((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun));
    Real nu = mu * mu_sun + sines * cos(lattice_azimuth(i));
    add_second_order(sunlit_ray(h, mu, meets_ground(h, mu), mu_sun, nu), push.samples,
                     push.scale_height_km, radiance, lost, ground);
  }
  bool done = push.end_direction == push.directions;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (done) {
      Real mean = 1.0 / Real(push.directions);
      lost[g] = lost[g] * mean;
      radiance[g] = min(radiance[g] * mean * series(lost[g], push.terms), Vec4(MOST_MEAN_RADIANCE));
      int ground_terms = push.terms > 0 ? push.terms - 1 : push.terms;
      ground[g] = ground[g] * mean * series(lost[g], ground_terms);
    }
    WRITE(parts, 3 * texel * GROUPS + g, radiance[g]);
    WRITE(parts, (3 * texel + 1) * GROUPS + g, lost[g]);
    WRITE(parts, (3 * texel + 2) * GROUPS + g, ground[g]);
  }
}
