#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// Closes the sum of orders by a geometric series and leaves it as skies read it: one invocation an altitude,
// a sun and a group of wavelengths; the altitude after the last is the ground's irradiance.
//
// Each order becomes the same share of the one before everywhere, soonest where the sun is high. In the
// planet's shadow the second order may be brighter than the first, for a while: the series takes a
// share that is little more than that under the highest sun.

// What all further orders add, over the last one.
Vec4 further(int at, int before, int at_noon, int before_noon) {
  Vec4 share = exp(moments[at] - moments[before]);
  Vec4 noon = exp(moments[at_noon] - moments[before_noon]);
  Vec4 ratio = clamp(min(share, 1.25 * noon), 0.0, 0.98);
  return push.tail != 0 ? ratio / (1.0 - ratio) : Vec4(0.0);
}

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int i = index / GROUPS / push.grid.suns;
  int noon = push.grid.suns - 1;
  bool ground = i == push.grid.altitudes;
  int at = (ground ? irradiance_at(i, s) : moment_at(i, s, 0)) + g;
  int at_noon = (ground ? irradiance_at(i, noon) : moment_at(i, noon, 0)) + g;
  Vec4 last = exp(moments[at]) * further(at, before_at(i, s) + g, at_noon, before_at(i, noon) + g);
  int sum = sum_table() + at;
  Vec4 lowest = moments[sum] + last;
  moments[sum] = moment_logarithm(lowest);
  if (ground) return;
  UNROLL for (int n = 1; n < SLOTS; ++n) {
    int own = n * GROUPS;
    moments[sum + own] = moment_ratio(moments[sum + own] + moments[at + own] * last, lowest);
  }
}
