#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"
int s, g;
int vector_at(int n, int i, int s);
#define CHUNK_BUFFER moments
#define CHUNK_PLACE(n, i) (vector_at(n, i, s) + g)
#define CHUNK_VALUES (push.grid.altitudes + 1)
#include "methods/later_orders.glsl"
#include "methods/moments_tail.glsl"

// The weights of the chunks: one invocation a sun and a group.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  g = index % GROUPS;
  s = index / GROUPS;
  int k = push.chunks - 1;
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    int at = lowest_at(i, s) + g;
    Vec4 sum = max(READ(moments, sum_table() + at), Vec4(DARKEST));
    Vec4 last = chunk(k, at) / sum;
    for (int n = 0; n < k; ++n) set_vector_value(n, i, chunk(n, at) / sum - last);
    set_vector_value(k, i, -last);
  }
  Vec4 weights[MOST_CHUNKS];
  weigh_chunks(k, weights);
  for (int n = 1; n <= k; ++n) WRITE(moments, weight_at(n, s) + g, weights[n]);
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    int at = lowest_at(i, s) + g;
    set_vector_value(0, i, later_orders(s, at, g) / max(chunk(k, at), Vec4(1e-30)));
  }
}
