#version 450
#extension GL_GOOGLE_include_directive : require
// Adds one order of a table to the sum of the orders and writes it as what is interpolated; or closes the sum with
// what all later orders are worth, and writes that. An invocation is all suns of one place and direction.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/later_orders.glsl"
#include "methods/bruneton/chunks.glsl"
layout(binding = FREE, rgba32f) uniform restrict readonly imageBuffer order_values;
layout(binding = FREE + 1, rgba32f) uniform restrict imageBuffer sums;
layout(binding = FREE + 2, rgba32f) uniform restrict readonly imageBuffer earlier_sums;
layout(binding = FREE + 3, rgba32f) uniform restrict readonly imageBuffer chunk_values;
layout(std430, binding = FREE + 4) restrict writeonly buffer ResultBuffer {
  Vec4 results[];
};

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int places;      // of the table: altitudes
  int directions;  // of the table
  int close;       // the sum, instead of adding an order
  int chunks;      // of orders, by which all later ones are told; 0 where none are added
  float largest_share;  // of a chunk in the one before
} push;

// Two neighbours in the sun's direction differ by a factor that changes from node to node by this
// much at the most: where the air sees no light at all, a cubic through its logarithm would swing.
const Real MOST_BEND = 2.0;

Vec4 chunk(int n, int texel) {
  int table = GROUPS * push.places * grid.suns * push.directions;
  Vec4 after = n + 1 < push.chunks ? READ(earlier_sums, (n + 1) * table + texel) : READ(sums, texel);
  return after - READ(earlier_sums, n * table + texel);
}

Vec4 later_orders(int texel, int sun, int group) {
  Vec4 later = Vec4(0.0);
  for (int n = 1; n < push.chunks; ++n) {
    later = later + chunk(n, texel) * READ(chunk_values, chunk_weight_at(n, sun) + group);
  }
  return max(later, Vec4(0.0));
}

void main() {
  load_grids();
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  int direction = item % push.directions;
  int place = item / push.directions;  // and group
  int group = place / push.places;
  Vec4 above = Vec4(0.0);
  Vec4 slope = Vec4(0.0);
  Vec4 to_last = Vec4(0.0);  // of all later orders, under the highest sun
  for (int s = grid.suns - 1; s >= 0; --s) {
    int texel = (place * grid.suns + s) * push.directions + direction;
    Vec4 value = READ(sums, texel);
    if (push.close == 0) {
      value = READ(order_values, texel);
      WRITE(sums, texel, READ(sums, texel) + value);
    } else if (push.chunks > 1) {
      Vec4 last = max(chunk(push.chunks - 1, texel), Vec4(0.0));
      Vec4 later = later_orders(texel, s, group);
      if (s == grid.suns - 1) to_last = later / max(last, Vec4(1e-30));
      value = value + min(later, most_later_orders(last, to_last, Vec4(push.largest_share)));
    }
    Vec4 code = encoded(value);
    if (LOGARITHMIC && s < grid.suns - 1) {
      code = max(code, above + (s < grid.suns - 2 ? slope : Vec4(0.0)) - MOST_BEND);
      slope = code - above;
    }
    above = code;
    results[texel] = code;
  }
}
