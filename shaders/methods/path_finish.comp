#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds the mean of all walks to the first order, and finds the standard error of their sum.
layout(binding = OWN, rgba32f) uniform restrict imageBuffer tile;
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer sums;
// Inscatter and ground of the first order by half as many nodes.
layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer coarse;

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int slices;
  int walks_of_ray;
} push;

// Sum of the walks of one slice.
Vec4 slice_sum(int i, int slice, int g) {
  int lane = i * push.slices + slice;
  int lanes = push.rays_in_tile * push.slices;
  return READ(sums, g * lanes + lane) + READ(sums, (GROUPS + g) * lanes + lane);
}

// Without the squares of what is far below 1, which a float does not hold.
Vec4 hypotenuse(Vec4 a, Vec4 b) {
  Vec4 most = max(max(a, b), Vec4(1e-35));
  a /= most;
  b /= most;
  return most * sqrt(a * a + b * b);
}

// Standard error of the mean of all walks, from the slices, whose sums are independent. A few
// heavy walks that most slices have not met make such an estimate too small: where one slice holds more
// of the squares than one of so many normal ones would in a thousand cases, the excess counts four times:
// the error is doubled where a single slice is all there is.
Vec4 error_of_mean(int i, int g, Vec4 mean) {
  // One walk alone says nothing of its error but that it is about its size.
  if (push.slices == 1) return mean;
  Vec4 unit = max(mean * Real(push.walks_of_ray), Vec4(1e-35));
  Vec4 squares = Vec4(0.0);
  Vec4 largest = Vec4(0.0);
  for (int s = 0; s < push.slices; ++s) {
    Real walks = Real((push.walks_of_ray - s + push.slices - 1) / push.slices);
    Vec4 deviation = (slice_sum(i, s, g) - mean * walks) / unit;
    squares += deviation * deviation;
    largest = max(largest, deviation * deviation);
  }
  Real slices = Real(push.slices);
  Vec4 expected = squares * min((2.0 * log(slices) + 8.0) / slices, 1.0);
  squares += 3.0 * max(largest - expected, Vec4(0.0));
  return unit * sqrt(squares * (slices / (slices - 1.0))) / Real(push.walks_of_ray);
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  int lanes = n * push.slices;
  Real walks = Real(max(push.walks_of_ray, 1));
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int inscatter_at = (INSCATTER * GROUPS + g) * n + i;
    int ground_at = (GROUND * GROUPS + g) * n + i;
    // Gauss rules gain digits with every node: a tenth of what half of them miss is a bound.
    Vec4 quadrature = 0.1 * abs(READ(tile, inscatter_at) + READ(tile, ground_at) - READ(coarse, inscatter_at) -
                                READ(coarse, ground_at));
    Vec4 error = quadrature;
    if (push.walks_of_ray > 0) {
      Vec4 sky = Vec4(0.0);
      Vec4 ground = Vec4(0.0);
      for (int s = 0; s < push.slices; ++s) {
        sky += READ(sums, g * lanes + i * push.slices + s);
        ground += READ(sums, (GROUPS + g) * lanes + i * push.slices + s);
      }
      error = hypotenuse(error, error_of_mean(i, g, (sky + ground) / walks));
      WRITE(tile, inscatter_at, READ(tile, inscatter_at) + sky / walks);
      WRITE(tile, ground_at, READ(tile, ground_at) + ground / walks);
    }
    WRITE(tile, (STANDARD_ERROR * GROUPS + g) * n + i, error);
  }
}
