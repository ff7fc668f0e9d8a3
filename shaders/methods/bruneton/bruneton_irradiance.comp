#version 450
#extension GL_GOOGLE_include_directive : require
// Diffuse irradiance of the ground under each sun: the radiance of one order at the lowest altitude,
// integrated over the upper hemisphere. An invocation is a sun.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(binding = FREE, rgba32f) uniform restrict readonly imageBuffer radiances;
layout(std430, binding = FREE + 1) restrict writeonly buffer IrradianceBuffer {
  Vec4 irradiances[];
};

layout(push_constant) uniform Push {
  int first_sun;
  int end_sun;
} push;

void main() {
  load_grids();
  int s = push.first_sun + int(gl_GlobalInvocationID.x);
  if (s >= push.end_sun) return;
  Vec4 sum[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) sum[g] = Vec4(0.0);
  for (int z = 0; z < grid.zeniths; ++z) {
    Real mu = node_cosine(0, z);
    if (mu <= 0.0) continue;
    for (int k = 0; k < grid.azimuths; ++k) {
      Real weight = node_solid_angle(0, z, k) * mu;
      int texel = (s * grid.zeniths + z) * grid.azimuths + k;
      UNROLL for (int g = 0; g < GROUPS; ++g) {
        sum[g] = sum[g] + weight * READ(radiances, g * texels() + texel);
      }
    }
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) irradiances[g * grid.suns + s] = sum[g];
}
