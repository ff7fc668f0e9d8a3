#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds the stars of a tile to the planes of the frame, dimmed and reddened by the air in front of
// them. One invocation a pixel that holds a star: stars that share a pixel were added up before.
layout(binding = OWN, rgba32f) uniform restrict readonly imageBuffer tile;
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer matrix;
layout(binding = OWN + 2, r32f) uniform restrict imageBuffer plane0;
layout(binding = OWN + 3, r32f) uniform restrict imageBuffer plane1;
layout(binding = OWN + 4, r32f) uniform restrict imageBuffer plane2;
layout(binding = OWN + 5, r32f) uniform restrict imageBuffer plane3;
layout(std430, binding = OWN + 6) restrict readonly buffer PixelBuffer { int star_pixels[]; };
// Radiance over the pixel per unit irradiance of the sun, by group of wavelengths.
layout(binding = OWN + 7, rgba32f) uniform restrict readonly imageBuffer star_radiance;

layout(push_constant) uniform Push {
  int first_ray;
  int rays_in_tile;
  int first_row;
  int first_star;
  int stars;
  int planes;        // 3 leaves plane 3 alone
  int listed;        // the rays are those of the pixels that hold stars
} push;

void main() {
  load_scene();
  int s = int(gl_GlobalInvocationID.x);
  if (s >= push.stars) return;
  int star = push.first_star + s;
  int at = star_pixels[star];
  int ray = push.listed != 0 ? star : at;
  PixelRay pixel = pixel_ray(ray);
  if (!pixel.inside || path_from_camera(pixel.direction).meets_ground) return;
  if (end_of_ray(ray) < ENDLESS) return;
  int i = ray - push.first_ray;
  Vec4 value = Vec4(0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 light = READ(star_radiance, star * GROUPS + g) *
                 READ(tile, (TRANSMITTANCE * GROUPS + g) * push.rays_in_tile + i);
    UNROLL for (int k = 0; k < 4; ++k) {
      value[k] += dot(READ(matrix, (push.first_row + k) * GROUPS + g), light);
    }
  }
  WRITE_REAL(plane0, at, READ_REAL(plane0, at) + value.x);
  WRITE_REAL(plane1, at, READ_REAL(plane1, at) + value.y);
  WRITE_REAL(plane2, at, READ_REAL(plane2, at) + value.z);
  if (push.planes > 3) WRITE_REAL(plane3, at, READ_REAL(plane3, at) + value.w);
}
