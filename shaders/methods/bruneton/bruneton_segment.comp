#version 450
#extension GL_GOOGLE_include_directive : require
// What the air before a point of a ray scatters towards the camera, and how much of the point's light it
// lets through. An invocation is a ray.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
#include "methods/bruneton/view_table.glsl"
#include "methods/bruneton/segment.glsl"
#define SINGLE_BINDING FREE
#include "methods/bruneton/single_table.glsl"
#include "methods/bruneton/single_view.glsl"
#define VIEW_BINDING (FREE + 2)
#include "methods/bruneton/multiple_view.glsl"
// Distances of the points from the camera, km.
layout(std430, binding = FREE + 3) restrict readonly buffer EndBuffer { Real ends_km[]; };
layout(std430, binding = FREE + 4) restrict writeonly buffer TileBuffer { Vec4 tile[]; };

layout(push_constant) uniform Push {
  int first;  // of this dispatch
  int end;
  int first_ray;
  int rays_in_tile;
  int multiple;  // orders from the second on too
} push;

void see(Path path, OUT_ARRAY(Vec4, seen, GROUPS_SIZE)) {
  UNROLL for (int g = 0; g < GROUPS; ++g) seen[g] = Vec4(0.0);
  if (path.length_km <= 0.0) return;
  add_single(path, seen);
  if (push.multiple == 0) return;
  ViewPosition at = view_position(path);
  UNROLL for (int g = 0; g < GROUPS; ++g) seen[g] = seen[g] + scattered(at, g);
}

// How far the camera is from where the path begins.
Real way_to_air(Path path) {
  Vec3 camera = Vec3(0.0, 0.0, scene.planet_radius_km + scene.camera_altitude_km);
  return dot(path.start - camera, path.direction);
}

void main() {
  int i = push.first + int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= push.end) return;
  load_scene();
  load_media();
  Path path = path_from_camera(pixel_ray(push.first_ray + i).direction);
  Real t = clamp(ends_km[i] - way_to_air(path), 0.0, path.length_km);
  Vec4 from_start[GROUPS];
  Vec4 from_end[GROUPS];
  see(path, from_start);
  see(path_beyond(path, t), from_end);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, t, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(column, g);
    tile[(INSCATTER * GROUPS + g) * n + i] = from_start[g] - transmittance * from_end[g];
    tile[(GROUND * GROUPS + g) * n + i] = Vec4(0.0);
    tile[(TRANSMITTANCE * GROUPS + g) * n + i] = transmittance;
  }
}
