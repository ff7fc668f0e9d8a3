#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"
#include "methods/moments_tail.glsl"

// The weights of the chunks: one invocation a sun and a group. With c_k = 1 - the others, |c_0 d_0 + ... + c_k d_k|
// is |d_k + sum of c_n (d_n - d_k)|, least squares by the modified Gram-Schmidt method, which keeps the digits
// that normal equations lose.

int s, g;

Vec4 product(int a, int b) {
  Vec4 sum = Vec4(0.0);
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    sum = sum + moments[vector_at(a, i, s) + g] * moments[vector_at(b, i, s) + g];
  }
  return sum;
}

// Takes `share` of the vector a from b.
void subtract(int a, Vec4 share, int b) {
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    int at = vector_at(b, i, s) + g;
    moments[at] = moments[at] - moments[vector_at(a, i, s) + g] * share;
  }
}

void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  g = index % GROUPS;
  s = index / GROUPS;
  int k = push.chunks - 1;
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    int at = lowest_at(i, s) + g;
    Vec4 sum = max(moments[sum_table() + at], Vec4(DARKEST));
    Vec4 last = chunk(k, at) / sum;
    for (int n = 0; n < k; ++n) moments[vector_at(n, i, s) + g] = chunk(n, at) / sum - last;
    moments[vector_at(k, i, s) + g] = -last;
  }

  // What a vector shares with those before it, [vector][before], and what is left of it with itself.
  Vec4 share[MOST_CHUNKS * MOST_CHUNKS];
  for (int n = 0; n < k; ++n) {
    Vec4 square = product(n, n);
    for (int m = n + 1; m <= k; ++m) {
      Vec4 in_both = product(n, m) / max(square, Vec4(1e-30));
      share[m * MOST_CHUNKS + n] = in_both;
      subtract(n, in_both, m);
    }
  }
  Vec4 c[MOST_CHUNKS];
  for (int n = k - 1; n >= 0; --n) {
    c[n] = share[k * MOST_CHUNKS + n];
    for (int m = n + 1; m < k; ++m) c[n] = c[n] - share[m * MOST_CHUNKS + n] * c[m];
  }
  Vec4 sum = Vec4(0.0);
  for (int n = 0; n < k; ++n) {
    sum = sum - c[n];
    moments[weight_at(n + 1, s) + g] = sum;
  }
  for (int i = 0; i <= push.grid.altitudes; ++i) {
    int at = lowest_at(i, s) + g;
    moments[vector_at(0, i, s) + g] = later_orders(s, at, g) / max(chunk(k, at), Vec4(1e-30));
  }
}
