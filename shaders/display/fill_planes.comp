#version 450
#extension GL_GOOGLE_include_directive : require
#include "display/cells.glsl"

// Cells of a plane of linear values, from those of their corners. The three are the same plane.
layout(binding = 1, r32f) uniform readonly imageBuffer plane;
layout(binding = 2, r32f) uniform writeonly imageBuffer values;
layout(binding = 3, rgba32f) uniform writeonly imageBuffer four_values;

void main() {
  int i = push.first + int(gl_GlobalInvocationID.x);
  if (i >= push.end) return;
  Chunk chunk = chunk_of(i);
  if (chunk.none) return;
  Ends ends = ends_of(chunk, AT_CORNERS(plane, chunk));
  int at = AT_ONCE == 4 ? chunk.first / 4 : chunk.first;
  int row = AT_ONCE == 4 ? push.width / 4 : push.width;
  for (int j = 0; j < chunk.rows; ++j) {
    vec4 four = ends.upper + (ends.lower - ends.upper) * (float(j) * chunk.a_row);
    if (AT_ONCE == 4) {
      imageStore(four_values, at + j * row, four);
    } else {
      imageStore(values, at + j * row, vec4(four.x));
    }
  }
}
