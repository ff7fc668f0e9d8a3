#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds the stars of a tile to the planes of the frame, dimmed and reddened by the air in front of
// them. One invocation a pixel that holds a star: stars that share a pixel were added up before.
layout(std430, binding = OWN) restrict readonly buffer TileBuffer { Vec4 tile[]; };
layout(std430, binding = OWN + 1) restrict readonly buffer MatrixBuffer { Vec4 matrix[]; };
layout(std430, binding = OWN + 2) restrict buffer Plane0 { Real plane0[]; };
layout(std430, binding = OWN + 3) restrict buffer Plane1 { Real plane1[]; };
layout(std430, binding = OWN + 4) restrict buffer Plane2 { Real plane2[]; };
layout(std430, binding = OWN + 5) restrict buffer Plane3 { Real plane3[]; };
layout(std430, binding = OWN + 6) restrict readonly buffer PixelBuffer { int star_pixels[]; };
// Radiance over the pixel per unit irradiance of the sun, by group of wavelengths.
layout(std430, binding = OWN + 7) restrict readonly buffer StarBuffer { Vec4 star_radiance[]; };

layout(push_constant) uniform Push {
  int first_ray;
  int rays_in_tile;
  int first_row;
  int first_star;
  int stars;
  int planes;        // 3 leaves plane 3 alone
} push;

void main() {
  int s = int(gl_GlobalInvocationID.x);
  if (s >= push.stars) return;
  int star = push.first_star + s;
  int at = star_pixels[star];
  load_scene();
  PixelRay pixel = pixel_ray(at);
  if (!pixel.inside || path_from_camera(pixel.direction).meets_ground) return;
  if (end_of_ray(at) < ENDLESS) return;
  int i = at - push.first_ray;
  Vec4 value = Vec4(0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 light = star_radiance[star * GROUPS + g] *
                 tile[(TRANSMITTANCE * GROUPS + g) * push.rays_in_tile + i];
    UNROLL for (int k = 0; k < 4; ++k) {
      value[k] += dot(matrix[(push.first_row + k) * GROUPS + g], light);
    }
  }
  plane0[at] += value.x;
  plane1[at] += value.y;
  plane2[at] += value.z;
  if (push.planes > 3) plane3[at] += value.w;
}
