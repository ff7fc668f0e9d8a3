#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds the mean of all walks to the first order, and finds the standard error of that mean from the
// slices, whose sums are independent.
layout(std430, binding = 8) restrict buffer TileBuffer { Vec4 tile[]; };
layout(std430, binding = 9) restrict readonly buffer SumBuffer { Vec4 sums[]; };

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int slices;
  int walks_of_ray;
} push;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n || push.walks_of_ray == 0) return;
  int lanes = n * push.slices;
  Real walks = Real(push.walks_of_ray);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 sky = Vec4(0.0);
    Vec4 ground = Vec4(0.0);
    for (int s = 0; s < push.slices; ++s) {
      sky += sums[g * lanes + i * push.slices + s];
      ground += sums[(GROUPS + g) * lanes + i * push.slices + s];
    }
    Vec4 mean = (sky + ground) / walks;
    Vec4 squares = Vec4(0.0);
    for (int s = 0; s < push.slices; ++s) {
      int lane = i * push.slices + s;
      Real share = Real((push.walks_of_ray - s + push.slices - 1) / push.slices);
      Vec4 deviation = sums[g * lanes + lane] + sums[(GROUPS + g) * lanes + lane] - mean * share;
      squares += deviation * deviation;
    }
    // One walk alone says nothing of its error but that it is no smaller than itself.
    Real slices = Real(push.slices);
    Vec4 error = push.slices > 1 ? sqrt(squares * (slices / (slices - 1.0))) / walks : mean;
    tile[(INSCATTER * GROUPS + g) * n + i] += sky / walks;
    tile[(GROUND * GROUPS + g) * n + i] += ground / walks;
    tile[(STANDARD_ERROR * GROUPS + g) * n + i] += error;
  }
}
