#version 450
#extension GL_GOOGLE_include_directive : require
// Interpolates a table in altitude and sun, by cubics through the four nodes about each place, on the finer
// grid from which it is read linearly: a cubic there costs once what it would cost in every sample of
// every path. An invocation is a texel of the finer grid.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(std430, binding = FREE) restrict readonly buffer CoarseBuffer { Vec4 coarse[]; };
layout(std430, binding = FREE + 1) restrict writeonly buffer FineBuffer { Vec4 fine[]; };

layout(push_constant) uniform Push {
  int first_texel;
  int end_texel;
  int directions;  // of the table
  int altitudes;   // of the coarse table: those of the grid, or one
  int factor;      // intervals of the finer grid in one of the coarser
} push;

struct Taps {
  int first;
  Real weight[4];
};

// Neighbours of a node of the finer grid.
Taps taps_about(int node, int count) {
  Taps taps;
  int interval = min(node / push.factor, max(count - 2, 0));
  taps.first = clamp(interval - 1, 0, max(count - 4, 0));
  Real t = Real(node) / Real(push.factor) - Real(taps.first);
  taps.weight[0] = (t - 1.0) * (t - 2.0) * (3.0 - t) / 6.0;
  taps.weight[1] = t * (t - 2.0) * (t - 3.0) / 2.0;
  taps.weight[2] = t * (t - 1.0) * (3.0 - t) / 2.0;
  taps.weight[3] = t * (t - 1.0) * (t - 2.0) / 6.0;
  if (count == 1) {
    taps.weight[0] = 1.0;
    taps.weight[1] = 0.0;
    taps.weight[2] = 0.0;
    taps.weight[3] = 0.0;
  }
  return taps;
}

void main() {
  int texel = push.first_texel + int(gl_GlobalInvocationID.x);
  if (texel >= push.end_texel) return;
  int fine_altitudes = (push.altitudes - 1) * push.factor + 1;
  int direction = texel % push.directions;
  int rest = texel / push.directions;
  Taps sun = taps_about(rest % source.suns, grid.suns);
  rest = rest / source.suns;
  Taps altitude = taps_about(rest % fine_altitudes, push.altitudes);
  int group = rest / fine_altitudes;
  Vec4 value = Vec4(0.0);
  UNROLL for (int a = 0; a < 4; ++a) {
    int row = group * push.altitudes + min(altitude.first + a, push.altitudes - 1);
    Vec4 in_row = Vec4(0.0);
    UNROLL for (int s = 0; s < 4; ++s) {
      in_row = in_row + sun.weight[s] *
                            coarse[(row * grid.suns + sun.first + s) * push.directions +
                                   direction];
    }
    value = value + altitude.weight[a] * in_row;
  }
  fine[texel] = value;
}
