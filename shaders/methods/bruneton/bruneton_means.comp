#version 450
#extension GL_GOOGLE_include_directive : require
// What chunks of orders add to the source, meant over its directions, and to the ground's irradiance, over their
// sums. An invocation is an altitude, or after the last one the ground, under one sun in one group of wavelengths.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/later_orders.glsl"
#include "methods/bruneton/chunks.glsl"
layout(std430, binding = FREE) restrict readonly buffer SourceBuffer { Vec4 source_sums[]; };
layout(std430, binding = FREE + 1) restrict readonly buffer EarlierBuffer { Vec4 earlier_sources[]; };
layout(std430, binding = FREE + 2) restrict readonly buffer IrradianceBuffer { Vec4 irradiance_sums[]; };
layout(std430, binding = FREE + 3) restrict readonly buffer EarlierIrradianceBuffer {
  Vec4 earlier_irradiances[];
};
layout(std430, binding = FREE + 4) restrict buffer ChunkBuffer { Vec4 chunk_values[]; };

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int directions;  // of the source, as computed
  int chunks;
} push;

void main() {
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  int g = item % GROUPS;
  int sun = item / GROUPS % grid.suns;
  int altitude = item / GROUPS / grid.suns;
  bool ground = altitude == grid.altitudes;
  int directions = ground ? 1 : push.directions;
  int texel = ground ? g * grid.suns + sun
                     : ((g * grid.altitudes + altitude) * grid.suns + sun) * directions;
  int table = GROUPS * grid.suns * (ground ? 1 : grid.altitudes * directions);
  Vec4 sums[MOST_CHUNKS + 1];
  for (int n = 0; n <= MOST_CHUNKS; ++n) sums[n] = Vec4(0.0);
  for (int i = 0; i < directions; ++i) {
    for (int n = 0; n < push.chunks; ++n) {
      int at = n * table + texel + i;
      sums[n] = sums[n] + (ground ? earlier_irradiances[at] : earlier_sources[at]);
    }
    sums[push.chunks] =
        sums[push.chunks] + (ground ? irradiance_sums[texel] : source_sums[texel + i]);
  }
  for (int n = 0; n < push.chunks; ++n) {
    chunk_values[chunk_mean_at(n, altitude, sun) + g] =
        (sums[n + 1] - sums[n]) / max(sums[push.chunks], Vec4(1e-30));
  }
}
