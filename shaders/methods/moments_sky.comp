#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_sky.glsl"

// The sky of a camera: one invocation a direction and a group. Kept are the logarithm of what the moments
// give, and over it what the aureole's function multiplies.
layout(std430, binding = OWN + 3) restrict writeonly buffer SkyBuffer { Vec4 sky[]; };

// What a node sends at x, from the points where it is known.
void gather(int sent, int points, Real x, OUT_ARRAY(Vec4, term, SENT)) {
  UNROLL for (int n = 0; n < SENT; ++n) term[n] = Vec4(0.0);
  for (int p = 0; p < points; ++p) {
    Real weight = chebyshev_weight(azimuth_point(p, points), points, x);
    UNROLL for (int n = 0; n < SENT; ++n) term[n] = term[n] + READ(ray_data, sent + (p * SENT + n) * GROUPS) * weight;
  }
}

void main() {
  load_scene();
  if (EACH_AZIMUTH) load_media();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int a = index / GROUPS % push.azimuths;
  int e = index / GROUPS / push.azimuths;
  SkyRay ray = sky_ray(e);
  Real x = cos(PI * Real(a) / Real(push.azimuths - 1));
  Vec4 smooth_light = Vec4(0.0);
  Vec4 aureole_light = Vec4(0.0);
  for (int k = 0; k < push.steps; ++k) {
    if (EACH_AZIMUTH) {
      SkyNode node = sky_node(ray, k);
      Sender sender = sender_at(ray, node, x, g);
      smooth_light = smooth_light + smooth_light_of(sender, azimuth_at(ray, node, x));
      aureole_light = aureole_light + aureole_of(sender);
    } else {
      Vec4 place = READ(ray_data, place_at(e, k));
      SkyNode node;
      node.altitude_km = place.x;
      node.mu = place.y;
      node.t_km = place.z;
      Vec4 term[SENT];
      gather(sent_at(e, k, 0) + g, int(place.w), x, term);
      Real c[MOST_DEGREE + 1];
      azimuth_terms(node.mu, axis_at(ray, x, node.t_km, node.altitude_km), nu_at(ray, x), DEGREE, c);
      UNROLL for (int m = 0; m <= DEGREE; ++m) smooth_light = smooth_light + term[m] * c[m];
      aureole_light = aureole_light + term[SERIES];
    }
  }
  int at = (e * push.azimuths + a) * 2 * GROUPS + g;
  sky[at] = moment_logarithm(smooth_light);
  sky[at + GROUPS] = moment_ratio(aureole_light, smooth_light);
}
