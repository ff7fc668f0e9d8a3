#version 450
#extension GL_GOOGLE_include_directive : require
// The weights of chunks of orders in all later ones. An invocation is a sun and a group of wavelengths.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(binding = FREE, rgba32f) uniform restrict imageBuffer chunk_values;
int sun, group;
int chunk_value_at(int n, int altitude, int sun);
#define CHUNK_BUFFER chunk_values
#define CHUNK_PLACE(n, i) (chunk_value_at(n, i, sun) + group)
#define CHUNK_VALUES (grid.altitudes + 1)
#include "methods/later_orders.glsl"
#include "methods/bruneton/chunks.glsl"

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int chunks;
} push;

void main() {
  load_grids();
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  group = item % GROUPS;
  sun = item / GROUPS;
  int k = push.chunks - 1;
  for (int i = 0; i < CHUNK_VALUES; ++i) {
    Vec4 last = vector_value(k, i);
    for (int n = 0; n < k; ++n) set_vector_value(n, i, vector_value(n, i) - last);
    set_vector_value(k, i, -last);
  }
  Vec4 weights[MOST_CHUNKS];
  weigh_chunks(k, weights);
  for (int n = 0; n <= k; ++n) WRITE(chunk_values, chunk_weight_at(n, sun) + group, weights[n]);
}
