#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// What each node of each ray scatters towards the ray's start, as a series in azimuth, under every sun
// that has a node: one invocation a node of a ray, a sun and a group.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int s = index / GROUPS % push.grid.suns;
  int k = index / GROUPS / push.grid.suns % push.steps;
  int j = index / GROUPS / push.grid.suns / push.steps % RAYS;
  int i = push.first_altitude + index / GROUPS / push.grid.suns / push.steps / RAYS;
  int node = node_at(i, j, k);
  Vec4 place = READ(ray_data, node);
  int low = min(int(place.w), push.fine_altitudes - 2);
  Real x = place.w - Real(low);
  int below = order_at(low, s) + g;
  int above = order_at(low + 1, s) + g;
  int nearest = x < 0.5 ? below : above;

  Real p[MOST_MOMENTS];
  zenith_polynomials(place.y, DEGREE, p);
  Vec4 term[SERIES + 1];
  UNROLL for (int m = 0; m <= SERIES; ++m) term[m] = Vec4(0.0);
  uvec4 pair = uvec4(0u);
  UNROLL for (int l = 0; l <= DEGREE; ++l) {
    if (!PARTICLES && l % 2 == 1) continue;
    Vec4 scattered = READ(ray_data, node + 2 + l * GROUPS + g);
    UNROLL for (int m = 0; m <= DEGREE; ++m) {
      if (m > l) continue;
      int n = moment_index(l, m);
      Vec4 ratio = Vec4(1.0);
      if (n > 0) {
        if (n % 2 == 1 || m == 0) pair = READ(fine_order, nearest + (n + 1) / 2 * GROUPS);
        ratio = n % 2 == 1 ? first_of(pair) : second_of(pair);
      }
      term[m] = term[m] + scattered * ratio * p[n];
    }
  }
  Vec4 logarithm = mix(uintBitsToFloat(READ(fine_order, below)), uintBitsToFloat(READ(fine_order, above)), x);

  // Packed over the even part of what the node scatters, which is kept with the logarithm: the same under
  // every sun.
  Vec4 even = max(READ(ray_data, node + 2 + g), Vec4(1e-30));
  int at = row_at(i, j, k, s) + g;
  UNROLL for (int pair = 0; pair < ROW_SLOTS - 1; ++pair) {
    WRITE(rows, at + pair * GROUPS, pack_pair(term[2 * pair] / even, term[2 * pair + 1] / even));
  }
  WRITE(rows, at + (ROW_SLOTS - 1) * GROUPS, floatBitsToUint(logarithm + log(even)));
}
