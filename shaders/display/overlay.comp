#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Adds a client's picture to the planes of a frame, as the air before it leaves it: what stands at the end of a
// ray, and behind rays that nothing ends what lies beyond the air. The transmittance is by quadrature along
// each ray, whatever method made the frame.
layout(std430, binding = OWN) restrict readonly buffer MatrixBuffer { Vec4 matrix[]; };
layout(std430, binding = OWN + 1) restrict readonly buffer Red { Real red[]; };
layout(std430, binding = OWN + 2) restrict readonly buffer Green { Real green[]; };
layout(std430, binding = OWN + 3) restrict readonly buffer Blue { Real blue[]; };
layout(std430, binding = OWN + 4) restrict buffer Plane0 { Real plane0[]; };
layout(std430, binding = OWN + 5) restrict buffer Plane1 { Real plane1[]; };
layout(std430, binding = OWN + 6) restrict buffer Plane2 { Real plane2[]; };
layout(std430, binding = OWN + 7) restrict buffer Plane3 { Real plane3[]; };

layout(push_constant) uniform Push {
  Vec4 luminance;      // of R, G, B in plane 3; 0 leaves that alone
  float object;        // weights: of what stands at the end of a ray,
  float background;    // of what lies beyond the air,
  float transmittance; // of the transmittance itself
  int first;
  int end;
} push;

void main() {
  int at = push.first + int(gl_GlobalInvocationID.x);
  if (at >= push.end) return;
  load_scene();
  load_media();
  PixelRay pixel = pixel_ray(at);
  Path path = path_of_ray(at, pixel);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, path.length_km, column);
  Vec3 transmittance = Vec3(0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 of_group = transmittance_of(column, g);
    transmittance += Vec3(dot(matrix[g], of_group), dot(matrix[GROUPS + g], of_group),
                          dot(matrix[2 * GROUPS + g], of_group));
  }
  bool object = end_of_ray(at) < ENDLESS;
  Real weight = object ? push.object : path.meets_ground ? 0.0 : push.background;
  if (!pixel.inside) weight = 0.0;
  Vec3 picture = Vec3(red[at], green[at], blue[at]);
  Vec3 light = transmittance * (weight * picture + push.transmittance);
  plane0[at] += light.x;
  plane1[at] += light.y;
  plane2[at] += light.z;
  Real luminance = dot(push.luminance.xyz, light);
  if (luminance != 0.0) plane3[at] = max(plane3[at], 0.0) + luminance;
}
