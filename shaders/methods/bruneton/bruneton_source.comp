#version 450
#extension GL_GOOGLE_include_directive : require
// The source of the next order at one altitude: the radiance of the last one, integrated over all
// directions with the phase functions [Bruneton and Neyret 2008, equation 8]. The sum of the shares over
// the grid is made 1 for every direction of the source, so that no grid loses or makes light. An
// invocation is a direction under one sun.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(binding = FREE, rgba32f) uniform restrict readonly imageBuffer shares;
layout(binding = FREE + 1, rgba32f) uniform restrict readonly imageBuffer radiances;
layout(std430, binding = FREE + 2) restrict writeonly buffer SourceBuffer {
  Vec4 sources[];
};

layout(push_constant) uniform Push {
  int first_item;
  int end_item;
  int altitude;
  int out_zeniths;  // directions of the source, as computed
  int out_azimuths;
} push;

void main() {
  load_grids();
  int item = push.first_item + int(gl_GlobalInvocationID.x);
  if (item >= push.end_item) return;
  int outgoing = push.out_zeniths * push.out_azimuths;
  int incoming = grid.zeniths * grid.azimuths;
  int direction = item % outgoing;
  int place = push.altitude * grid.suns + item / outgoing;
  Vec4 sum[GROUPS];
  Vec4 total[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    sum[g] = Vec4(0.0);
    total[g] = Vec4(0.0);
  }
  for (int i = 0; i < incoming; ++i) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 share = READ(shares, (g * incoming + i) * outgoing + direction);
      sum[g] = sum[g] + share * READ(radiances, g * texels() + place * incoming + i);
      total[g] = total[g] + share;
    }
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    sources[(g * grid.altitudes * grid.suns + place) * outgoing + direction] =
        sum[g] / max(total[g], Vec4(1e-30));
  }
}
