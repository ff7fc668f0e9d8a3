#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds a client's picture to the planes of a frame, as the air before it leaves it: what stands at the end of a
// ray, and behind rays that nothing ends what lies beyond the air. The transmittance is by quadrature along
// each ray, whatever method made the frame.
layout(binding = OWN, rgba32f) uniform restrict readonly imageBuffer matrix;
layout(binding = OWN + 1, r32f) uniform restrict readonly imageBuffer red;
layout(binding = OWN + 2, r32f) uniform restrict readonly imageBuffer green;
layout(binding = OWN + 3, r32f) uniform restrict readonly imageBuffer blue;
layout(binding = OWN + 4, r32f) uniform restrict imageBuffer plane0;
layout(binding = OWN + 5, r32f) uniform restrict imageBuffer plane1;
layout(binding = OWN + 6, r32f) uniform restrict imageBuffer plane2;
layout(binding = OWN + 7, r32f) uniform restrict imageBuffer plane3;

layout(push_constant) uniform Push {
  Vec4 luminance;      // of R, G, B in plane 3; 0 leaves that alone
  float object;        // weights: of what stands at the end of a ray,
  float background;    // of what lies beyond the air,
  float transmittance; // of the transmittance itself
  int first;
  int end;
} push;

void main() {
  load_scene();
  load_media();
  int at = push.first + int(gl_GlobalInvocationID.x);
  if (at >= push.end) return;
  PixelRay pixel = pixel_ray(at);
  Path path = path_of_ray(at, pixel);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, path.length_km, column);
  Vec3 transmittance = Vec3(0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 of_group = transmittance_of(column, g);
    transmittance += Vec3(dot(READ(matrix, g), of_group), dot(READ(matrix, GROUPS + g), of_group),
                          dot(READ(matrix, 2 * GROUPS + g), of_group));
  }
  bool object = end_of_ray(at) < ENDLESS;
  Real weight = object ? push.object : path.meets_ground ? 0.0 : push.background;
  if (!pixel.inside) weight = 0.0;
  Vec3 picture = Vec3(READ_REAL(red, at), READ_REAL(green, at), READ_REAL(blue, at));
  Vec3 light = transmittance * (weight * picture + push.transmittance);
  WRITE_REAL(plane0, at, READ_REAL(plane0, at) + light.x);
  WRITE_REAL(plane1, at, READ_REAL(plane1, at) + light.y);
  WRITE_REAL(plane2, at, READ_REAL(plane2, at) + light.z);
  Real luminance = dot(push.luminance.xyz, light);
  if (luminance != 0.0) WRITE_REAL(plane3, at, max(READ_REAL(plane3, at), 0.0) + luminance);
}
