#version 450
#extension GL_GOOGLE_include_directive : require
// The end of multiple scattering: light of all orders but the first, the ground's share with it. An
// invocation is a texel.
#include "device.glsl"

layout(constant_id = 12) const int MULTIPLE_SUNS = 2;
layout(constant_id = 13) const int MULTIPLE_ALTITUDES = 2;

layout(binding = OWN, rgba32f) uniform restrict readonly imageBuffer parts;
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer suns;
layout(std430, binding = OWN + 2) restrict writeonly buffer MultipleBuffer { Vec4 log_multiple[]; };
layout(std430, binding = OWN + 3) restrict writeonly buffer IrradianceBuffer { Vec4 log_irradiance[]; };

layout(push_constant) uniform Push {
  int first;
  int end;
} push;

void main() {
  int texel = push.first + int(gl_GlobalInvocationID.x);
  if (texel >= push.end) return;
  int sun = texel % MULTIPLE_SUNS;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 radiance = READ(parts, 3 * texel * GROUPS + g) +
                    READ(parts, (3 * texel + 2) * GROUPS + g) * READ(suns, 2 * sun * GROUPS + g);
    log_multiple[texel * GROUPS + g] = log(max(radiance, Vec4(1e-30)));
    if (texel < MULTIPLE_SUNS) {
      log_irradiance[texel * GROUPS + g] = READ(suns, (2 * texel + 1) * GROUPS + g);
    }
  }
}
