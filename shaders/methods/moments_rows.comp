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
  Vec4 place = ray_data[node];
  int low = min(int(place.w), push.fine_altitudes - 2);
  Real x = place.w - Real(low);
  int below = fine_table() + moment_at(low, s, 0) + g;
  int above = fine_table() + moment_at(low + 1, s, 0) + g;
  Real p[MOST_MOMENTS];
  zenith_polynomials(place.y, DEGREE, p);
  Vec4 term[DEGREE + 1];
  UNROLL for (int m = 0; m <= DEGREE; ++m) term[m] = Vec4(0.0);
  UNROLL for (int l = 0; l <= DEGREE; ++l) {
    if (!PARTICLES && l % 2 == 1) continue;
    Vec4 scattered = ray_data[node + 2 + l * GROUPS + g];
    UNROLL for (int m = 0; m <= l; ++m) {
      int n = moment_index(l, m);
      Vec4 ratio = Vec4(1.0);
      if (n > 0) ratio = mix(moments[below + n * GROUPS], moments[above + n * GROUPS], x);
      term[m] = term[m] + scattered * ratio * p[n];
    }
  }
  int at = row_at(i, j, k, s) + g;
  UNROLL for (int m = 0; m <= DEGREE; ++m) rows[at + m * GROUPS] = term[m];
  rows[at + (DEGREE + 1) * GROUPS] = mix(moments[below], moments[above], x);
}
