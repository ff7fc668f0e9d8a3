#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"
#include "methods/later_orders.glsl"
#include "methods/moments_tail.glsl"

// Adds all later orders to the sum and leaves it as skies read it: one invocation an altitude, a sun and a group
// of wavelengths; the altitude after the last is the ground's irradiance.

const Real LARGEST_SHARE = 0.9998;
// No mean radiance (of which a table with few altitudes may make ever more) is larger than that deep in air that
// absorbs nothing under a sun in the zenith: sqrt(3) / (4 pi) H(1) = 0.401 where it scatters evenly [Chandrasekhar
// 1960, chapters III and V], some hundredths more where forward. The ground's irradiance is at most pi times that,
// where the sky is as bright everywhere.
const Real LARGEST_MEAN = 0.42;

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int i = index / GROUPS / push.grid.suns;
  bool ground = i == push.grid.altitudes;
  int at = lowest_at(i, s) + g;
  int sum = sum_table() + at;
  Vec4 later = Vec4(0.0);
  Vec4 allowed = Vec4(1.0);  // of what the series says
  if (push.chunks > 1) {
    later = later_orders(s, at, g);
    Vec4 last = max(chunk(push.chunks - 1, at), Vec4(0.0));
    Vec4 to_last = READ(moments, vector_at(0, i, push.grid.suns - 1) + g);  // at noon
    Vec4 most = most_later_orders(last, to_last, Vec4(LARGEST_SHARE));
    if (!NEAR_SUN) most = min(most, max((ground ? PI : 1.0) * LARGEST_MEAN - READ(moments, sum), Vec4(0.0)));
    // Where the lowest moment has nothing to add, the others have not.
    allowed = min(most, later) / max(later, Vec4(1e-30));
  }
  Vec4 lowest = READ(moments, sum) + later * allowed;
  WRITE(moments, sum, moment_logarithm(lowest));
  if (ground) return;
  UNROLL for (int n = 1; n < SLOTS; ++n) {
    int own = n * GROUPS;
    Vec4 more = Vec4(0.0);
    for (int m = 1; m < push.chunks; ++m) more = more + chunk(m, at + own) * READ(moments, weight_at(m, s) + g);
    WRITE(moments, sum + own, moment_ratio(READ(moments, sum + own) + more * allowed, lowest));
  }
}
