#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// A tile's spectral quantities become up to four planes of the frame: the sun's disc is added behind
// the air, and one row of the output matrix is applied for each plane.
layout(binding = OWN, rgba32f) uniform restrict readonly imageBuffer tile;
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer matrix;
layout(binding = OWN + 2, r32f) uniform restrict imageBuffer plane0;
layout(binding = OWN + 3, r32f) uniform restrict imageBuffer plane1;
layout(binding = OWN + 4, r32f) uniform restrict imageBuffer plane2;
layout(binding = OWN + 5, r32f) uniform restrict imageBuffer plane3;
layout(binding = OWN + 6, r32ui) uniform restrict readonly uimageBuffer pixels;  // of rays from a list

layout(push_constant) uniform Push {
  Vec4 inscatter;      // weight of each quantity in the four planes
  Vec4 ground;
  Vec4 sun;
  Vec4 transmittance;
  int first_ray;
  int rays_in_tile;
  int first_row;       // of the matrix
  int accumulate;      // add to what other wavelengths left
  int mark_outside;    // plane 3 is -1 where the ray meets neither air nor ground
  int listed;          // the rays are those of listed pixels
} push;

void main() {
  load_scene();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_from_camera(pixel.direction);
  // What a client's picture shows at the end of a ray hides all behind it.
  bool hidden = end_of_ray(push.first_ray + i) < ENDLESS;
  bool sky = pixel.inside && !path.meets_ground && !hidden;
  Vec3 camera = Vec3(0.0, 0.0, scene.planet_radius_km + scene.camera_altitude_km);
  Vec4 value = Vec4(0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 inscatter = READ(tile, (INSCATTER * GROUPS + g) * n + i);
    Vec4 ground = hidden && scene.surface == 0 ? Vec4(0.0) : READ(tile, (GROUND * GROUPS + g) * n + i);
    Vec4 transmittance = READ(tile, (TRANSMITTANCE * GROUPS + g) * n + i);
    Vec4 sun = sky ? transmittance * disc_radiance(pixel.direction, camera, limb_exponent(g),
                                                   disc_scale(g), scene.pixel_rad)
                   : Vec4(0.0);
    UNROLL for (int k = 0; k < 4; ++k) {
      Vec4 light = push.inscatter[k] * inscatter + push.ground[k] * ground +
                   push.sun[k] * sun + push.transmittance[k] * transmittance;
      value[k] += dot(READ(matrix, (push.first_row + k) * GROUPS + g), light);
    }
  }
  int at = push.listed != 0 ? int(READ_UINT(pixels, push.first_ray + i)) : push.first_ray + i;
  if (push.accumulate != 0) {
    value += Vec4(READ_REAL(plane0, at), READ_REAL(plane1, at), READ_REAL(plane2, at), READ_REAL(plane3, at));
  }
  if (push.mark_outside != 0 && !(pixel.inside && meets_planet(path))) value.w = -1.0;
  WRITE_REAL(plane0, at, value.x);
  WRITE_REAL(plane1, at, value.y);
  WRITE_REAL(plane2, at, value.z);
  WRITE_REAL(plane3, at, value.w);
}
