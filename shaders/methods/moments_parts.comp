#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_sky.glsl"
#include "methods/moments_parts.glsl"

// From one stop of the sky's rays to the next: one invocation a direction and a group. Kept are the light so
// far, and of its ratio the logarithm and over that what the aureole's function multiplies.
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer light;
layout(std430, binding = OWN + 4) restrict writeonly buffer PartBuffer { Vec4 parts[]; };

void main() {
  load_scene();
  load_media();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int a = index / GROUPS % push.azimuths;
  int e = index / GROUPS / push.azimuths;
  SkyRay ray = sky_ray(e);
  Real x = cos(PI * Real(a) / Real(push.azimuths - 1));
  Stops stops = stops_of(ray.altitude_km, ray.mu, ray.length_km);
  Real from_km = push.stop > 0 ? stop_km(stops, push.stop - 1, PART_STOPS) : 0.0;
  Real to_km = stop_km(stops, push.stop, PART_STOPS);
  Vec4 smooth_light = push.stop > 0 ? READ(light, 2 * index) : Vec4(0.0);
  Vec4 aureole_light = push.stop > 0 ? READ(light, 2 * index + 1) : Vec4(0.0);
  ROLLED for (int k = 0; k < 3; ++k) {
    SkyNode node;
    node.t_km = from_km + (to_km - from_km) * gauss3_node(k);
    node.width_km = (to_km - from_km) * gauss3_weight(k);
    node.altitude_km = altitude_after(ray.altitude_km, ray.mu, node.t_km);
    node.mu = mu_after(ray.altitude_km, ray.mu, node.t_km, node.altitude_km);
    Sender sender = sender_at(ray, node, x, g);
    smooth_light = smooth_light + smooth_light_of(sender, azimuth_at(ray, node, x));
    aureole_light = aureole_light + aureole_of(sender);
  }
  WRITE(light, 2 * index, smooth_light);
  WRITE(light, 2 * index + 1, aureole_light);
  Real column[MEDIA_SIZE];
  columns_along(ray.altitude_km, ray.mu, to_km, column);
  int at = (((e * push.azimuths + a) * PART_STOPS + push.stop) * 2) * GROUPS + g;
  parts[at] = moment_logarithm(smooth_light / max(part_scattered(column, g), Vec4(1e-30)));
  parts[at + GROUPS] = moment_ratio(aureole_light, smooth_light);
}
