#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "device.glsl"
// What heights are of; 0 where there are none.
layout(constant_id = 10) const int SURFACE_KIND = 0;
#include "surface/surface.glsl"

// Shadows of heights in the air, in less detail than on the ground: a node stands for kilometres.
const Real SHADOW_DETAIL = 1e-4;  // of the planet's radius
Real sun_in_air(Vec3 position, Real altitude_km, Vec3 to_sun) {
  if (SURFACE_KIND == SURFACE_UNIFORM) return 1.0;
  return sun_over_heights(position, altitude_km, to_sun, SHADOW_DETAIL * scene.planet_radius_km);
}
#define SUN_OVER_HEIGHTS(position, altitude_km, to_sun) sun_in_air(position, altitude_km, to_sun)
#include "methods/raymarch.glsl"

layout(binding = OWN, rgba32f) uniform restrict imageBuffer tile;
// How far along each ray the march has come under the present sun, km.
layout(binding = OWN + 1, r32f) uniform restrict imageBuffer progress_km;

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int view_nodes;
  int sun;
  int pieces;         // of this dispatch
  int first;          // of the sun's dispatches
  int last;           // of all
} push;

void main() {
  load_scene();
  load_media();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  bool fresh = push.sun == 0 && push.first != 0;
  Vec4 inscatter[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = fresh ? Vec4(0.0) : READ(tile, (INSCATTER * GROUPS + g) * n + i);
    ground[g] = fresh ? Vec4(0.0) : READ(tile, (GROUND * GROUPS + g) * n + i);
  }
  Real from_km = push.first != 0 ? 0.0 : READ_REAL(progress_km, i);
  march_towards(path, push.sun, push.view_nodes, push.pieces, from_km, inscatter);
  if (push.first != 0 && scene.surface == 0) light_ground_from(path, push.sun, ground);
  WRITE_REAL(progress_km, i, from_km);

  Real column[MEDIA_SIZE];
  if (push.last != 0) columns_along(path.altitude_km, path.mu, path.length_km, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (push.last != 0) {
      Vec4 transmittance = transmittance_of(column, g);
      WRITE(tile, (TRANSMITTANCE * GROUPS + g) * n + i, transmittance);
      ground[g] = ground[g] * transmittance;
    }
    WRITE(tile, (INSCATTER * GROUPS + g) * n + i, inscatter[g]);
    WRITE(tile, (GROUND * GROUPS + g) * n + i, ground[g]);
  }
}
