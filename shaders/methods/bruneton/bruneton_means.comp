#version 450
#extension GL_GOOGLE_include_directive : require
// What chunks of orders add to the source in all directions together, and to the ground's irradiance, over the
// sums of all. An invocation is an altitude, or after the last one the ground, under one sun in one group of wavelengths.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/later_orders.glsl"
#include "methods/bruneton/chunks.glsl"
layout(binding = FREE, rgba32f) uniform restrict readonly imageBuffer source_sums;
layout(binding = FREE + 1, rgba32f) uniform restrict readonly imageBuffer earlier_sources;
layout(binding = FREE + 2, rgba32f) uniform restrict readonly imageBuffer irradiance_sums;
layout(binding = FREE + 3, rgba32f) uniform restrict readonly imageBuffer earlier_irradiances;
layout(std430, binding = FREE + 4) restrict buffer ChunkBuffer { Vec4 chunk_values[]; };

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int directions;  // of the source, as computed
  int chunks;
} push;

int first_texel(int altitude, int sun, int g) {
  if (altitude == grid.altitudes) return g * grid.suns + sun;
  return ((g * grid.altitudes + altitude) * grid.suns + sun) * push.directions;
}

// The sum of what came before chunk n, or of all, at a place of the table.
Vec4 source_before(int n, int texel) {
  if (n == push.chunks) return READ(source_sums, texel);
  return READ(earlier_sources, n * GROUPS * grid.altitudes * grid.suns * push.directions + texel);
}
Vec4 irradiance_before(int n, int texel) {
  if (n == push.chunks) return READ(irradiance_sums, texel);
  return READ(earlier_irradiances, n * GROUPS * grid.suns + texel);
}

void main() {
  load_grids();
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  int g = item % GROUPS;
  int sun = item / GROUPS % grid.suns;
  int altitude = item / GROUPS / grid.suns;
  int texel = first_texel(altitude, sun, g);
  Vec4 sums[MOST_CHUNKS + 1];
  for (int n = 0; n <= push.chunks; ++n) {
    sums[n] = Vec4(0.0);
    if (altitude == grid.altitudes) {
      sums[n] = irradiance_before(n, texel);
    } else {
      for (int i = 0; i < push.directions; ++i) sums[n] = sums[n] + source_before(n, texel + i);
    }
  }
  for (int n = 0; n < push.chunks; ++n) {
    chunk_values[chunk_value_at(n, altitude, sun) + g] =
        (sums[n + 1] - sums[n]) / max(sums[push.chunks], Vec4(1e-30));
  }
}
