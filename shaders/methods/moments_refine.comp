#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"
#include "methods/moments.glsl"

// A table with more nodes along one of its axes, by cubic interpolation, so that its readers can do with
// linear: [outer][nodes][inner] becomes [outer][fine][inner].
layout(binding = OWN, rgba32f) uniform readonly imageBuffer coarse;
layout(std430, binding = OWN + 1) writeonly buffer FineBuffer { Vec4 refined[]; };

layout(push_constant) uniform Push {
  int from, to;      // where the tables begin
  int nodes, fine;
  int inner;
  int mirrored;      // whether the function is even about both ends
  int first, end;    // invocations of this dispatch, one a value
} push;

int mirrored_node(int node) {
  int last = push.nodes - 1;
  int inside = node < 0 ? -node : node;
  return inside > last ? 2 * last - inside : inside;
}

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int inner = index % push.inner;
  int f = index / push.inner % push.fine;
  int outer = index / push.inner / push.fine;
  Real node = Real(f * (push.nodes - 1)) / Real(push.fine - 1);
  CubicTaps taps = cubic_taps(node, push.nodes);
  if (push.mirrored != 0) {
    // As if there were one more node at either end.
    taps = cubic_taps(node + 1.0, push.nodes + 2);
    taps.first -= 1;
  }
  Vec4 value[4];
  UNROLL for (int tap = 0; tap < 4; ++tap) {
    int n = mirrored_node(taps.first + tap);
    value[tap] = READ(coarse, push.from + (outer * push.nodes + n) * push.inner + inner);
  }
  refined[push.to + index] = limited_sum(value, taps);
}
