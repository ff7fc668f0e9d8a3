#version 450
#extension GL_GOOGLE_include_directive : require
// Interpolates a table in two of its coordinates, by cubics through the four nodes about each place, on the
// finer grid from which it is read linearly: a cubic there costs once what it would cost in every
// sample of every path. An invocation is a texel of the finer grid.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(binding = FREE, rgba32f) uniform restrict readonly imageBuffer coarse;
layout(std430, binding = FREE + 1) restrict writeonly buffer FineBuffer { Vec4 fine[]; };

layout(push_constant) uniform Push {
  int first_texel;
  int end_texel;
  int rows;     // nodes of the coarse table in the slower of the two coordinates
  int columns;  // and in the faster one
  int inner;    // values of each
  int factor;   // intervals of the finer grid in one of the coarser
} push;

// Neighbours of a node of the finer grid: the first of four, or all there are.
struct Taps {
  int first;
  Real weight[4];
};

Taps taps_about(int node, int count) {
  Taps taps;
  int interval = min(node / push.factor, max(count - 2, 0));
  taps.first = clamp(interval - 1, 0, max(count - 4, 0));
  Real t = Real(node) / Real(push.factor) - Real(taps.first);
  UNROLL for (int i = 0; i < 4; ++i) {
    taps.weight[i] = i < count ? 1.0 : 0.0;
    UNROLL for (int other = 0; other < 4; ++other) {
      if (other != i && other < count) {
        taps.weight[i] = taps.weight[i] * (t - Real(other)) / Real(i - other);
      }
    }
  }
  return taps;
}

void main() {
  load_grids();
  int texel = push.first_texel + int(gl_GlobalInvocationID.x);
  if (texel >= push.end_texel) return;
  int fine_rows = (push.rows - 1) * push.factor + 1;
  int fine_columns = (push.columns - 1) * push.factor + 1;
  int inner = texel % push.inner;
  int rest = texel / push.inner;
  Taps column = taps_about(rest % fine_columns, push.columns);
  rest = rest / fine_columns;
  Taps row = taps_about(rest % fine_rows, push.rows);
  int table = rest / fine_rows;
  Vec4 value = Vec4(0.0);
  UNROLL for (int r = 0; r < 4; ++r) {
    int first = (table * push.rows + min(row.first + r, push.rows - 1)) * push.columns;
    Vec4 in_row = Vec4(0.0);
    UNROLL for (int c = 0; c < 4; ++c) {
      int node = first + min(column.first + c, push.columns - 1);
      in_row = in_row + column.weight[c] * READ(coarse, node * push.inner + inner);
    }
    value = value + row.weight[r] * in_row;
  }
  fine[texel] = value;
}
