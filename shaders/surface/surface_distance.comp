#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "device.glsl"
layout(constant_id = 10) const int SURFACE_KIND = 0;
#include "surface/surface.glsl"

// Where each ray meets the ground, km from the camera; ENDLESS where it does not. An invocation is a ray.
layout(std430, binding = OWN) restrict writeonly buffer DistanceBuffer { Real distances_km[]; };

layout(push_constant) uniform Push {
  int first;
  int end;
} push;

void main() {
  load_scene();
  int ray = push.first + int(gl_GlobalInvocationID.x);
  if (ray >= push.end) return;
  PixelRay pixel = pixel_ray(ray);
  Path path = path_from_camera(pixel.direction);
  Vec3 camera = Vec3(0.0, 0.0, scene.planet_radius_km + scene.camera_altitude_km);
  Real before_km = length(path.start - camera);
  Real distance_km = distance_to_surface(path, before_km);
  distances_km[ray] = pixel.inside && distance_km < ENDLESS ? before_km + distance_km : ENDLESS;
}
