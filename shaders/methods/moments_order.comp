#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// An order with more altitudes, by cubic interpolation, so that rays can read the node next to them: one
// invocation an altitude, a sun, a slot and a group.

CubicTaps taps;

Vec4 slot_at(int s, int n, int g) {
  Vec4 value[4];
  UNROLL for (int tap = 0; tap < 4; ++tap) value[tap] = READ(moments, moment_at(taps.first + tap, s, n) + g);
  return limited_sum(value, taps);
}

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int slot = index / GROUPS % ORDER_SLOTS;
  int s = index / GROUPS / ORDER_SLOTS % push.grid.suns;
  int f = index / GROUPS / ORDER_SLOTS / push.grid.suns;
  taps = cubic_taps(Real(f * (push.grid.altitudes - 1)) / Real(push.fine_altitudes - 1), push.grid.altitudes);
  if (slot == 0) {
    WRITE(fine_order, index, floatBitsToUint(slot_at(s, 0, g)));
  } else {
    WRITE(fine_order, index, pack_pair(slot_at(s, 2 * slot - 1, g), slot_at(s, min(2 * slot, AUREOLE - 1), g)));
  }
}
