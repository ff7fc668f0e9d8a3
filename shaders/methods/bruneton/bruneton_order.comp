#version 450
#extension GL_GOOGLE_include_directive : require
// Adds one order of a table to the sum of the orders, and writes what is to be interpolated: that order
// alone, or the sum with what the orders beyond are worth. An invocation is all suns of one place and
// direction.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(std430, binding = FREE) restrict readonly buffer OrderBuffer {
  Vec4 order_values[];
};
layout(std430, binding = FREE + 1) restrict readonly buffer PreviousBuffer {
  Vec4 previous_values[];
};
layout(std430, binding = FREE + 2) restrict buffer SumBuffer { Vec4 sums[]; };
layout(std430, binding = FREE + 3) restrict writeonly buffer ResultBuffer {
  Vec4 results[];
};

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int directions;  // of the table
  int first_order; // begins the sum
  int last_order;  // writes the sum
  int tail;        // orders beyond the last, -1 all
  float most_ratio;
} push;

// Two neighbours in the sun's direction differ by a factor that changes from node to node by this
// much at the most: where the air sees no light at all, a cubic through its logarithm would swing.
const Real MOST_BEND = 2.0;

// The orders beyond as a geometric series of the ratio of the last two.
Vec4 beyond(Vec4 last, Vec4 previous) {
  if (push.tail == 0) return Vec4(0.0);
  Vec4 ratio = clamp(last / max(previous, Vec4(1e-30)), Vec4(0.0), Vec4(push.most_ratio));
  Vec4 cut = push.tail < 0 ? Vec4(0.0) : pow(max(ratio, Vec4(1e-30)), Vec4(Real(push.tail)));
  return last * ratio * (1.0 - cut) / (1.0 - ratio);
}

void main() {
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  int direction = item % push.directions;
  int place = item / push.directions;  // and group
  Vec4 above = Vec4(0.0);
  Vec4 slope = Vec4(0.0);
  for (int s = grid.suns - 1; s >= 0; --s) {
    int texel = (place * grid.suns + s) * push.directions + direction;
    Vec4 value = order_values[texel];
    Vec4 sum = value;
    if (push.first_order == 0) sum = sum + sums[texel];
    sums[texel] = sum;
    if (push.last_order != 0) value = sum + beyond(value, previous_values[texel]);
    Vec4 code = encoded(value);
    if (LOGARITHMIC && s < grid.suns - 1) {
      code = max(code, above + (s < grid.suns - 2 ? slope : Vec4(0.0)) - MOST_BEND);
      slope = code - above;
    }
    above = code;
    results[texel] = code;
  }
}
