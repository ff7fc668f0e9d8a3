#version 450
#extension GL_GOOGLE_include_directive : require
#include "display/cells.glsl"
#include "display/packed.glsl"

// Cells of displayed pixels, from the levels of their corners.
layout(binding = 1, r32f) uniform readonly imageBuffer red;
layout(binding = 2, r32f) uniform readonly imageBuffer green;
layout(binding = 3, r32f) uniform readonly imageBuffer blue;
layout(binding = 4, r32ui) uniform writeonly uimageBuffer pixels;        // these two are the same
layout(binding = 5, rgba32ui) uniform writeonly uimageBuffer four_pixels;

void main() {
  int i = push.first + int(gl_GlobalInvocationID.x);
  if (i >= push.end) return;
  Chunk chunk = chunk_of(i);
  if (chunk.none) return;
  Ends r = ends_of(chunk, AT_CORNERS(red, chunk));
  Ends g = ends_of(chunk, AT_CORNERS(green, chunk));
  Ends b = ends_of(chunk, AT_CORNERS(blue, chunk));
  int at = AT_ONCE == 4 ? chunk.first / 4 : chunk.first;
  int row = AT_ONCE == 4 ? push.width / 4 : push.width;
  for (int j = 0; j < chunk.rows; ++j) {
    float down = float(j) * chunk.a_row;
    uvec4 bytes_r = uvec4(r.upper + (r.lower - r.upper) * down + 0.5);
    uvec4 bytes_g = uvec4(g.upper + (g.lower - g.upper) * down + 0.5);
    uvec4 bytes_b = uvec4(b.upper + (b.lower - b.upper) * down + 0.5);
    uvec4 packed_four = bytes_r | (bytes_g << 8) | (bytes_b << 16) | 0xff000000u;
    if (AT_ONCE == 4) {
      imageStore(four_pixels, at + j * row, packed_four);
    } else {
      imageStore(pixels, at + j * row, uvec4(packed_four.x));
    }
  }
}
