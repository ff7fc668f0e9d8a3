#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "methods/moments_view.glsl"
Real view_share[MEDIA_SIZE];
#define VIEW_SHARE(c) view_share[c]
#include "methods/raymarch.glsl"

// A pixel: order one by the march, what was scattered more than once from the sky's table, and the
// ground under the light of the whole sky.
layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer sky;
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer tile;
// How far along each ray the march has come under the present sun, km.
layout(binding = OWN + 4, r32f) uniform restrict imageBuffer progress_km;

layout(push_constant) uniform Push {
  MomentGrid grid;
  int irradiance;      // where it lies behind the moments
  int fine_suns;
  int elevations, azimuths;
  int first_ray;       // of the tile, in the frame
  int rays_in_tile;
  int view_nodes;
  int sun;
  int pieces;          // of this dispatch
  int first;           // of the sun's dispatches
  int last;            // of all
  int orders;          // 1, or more
  int cut_only;        // 1: rays that end at something alone
} push;

const int SKY_VALUES = 2 * GROUPS;
#include "methods/moments_pixel.glsl"

void main() {
  load_scene();
  load_media();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  UNROLL for (int c = 0; c < MEDIA; ++c) view_share[c] = share_of_extinction(c);
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  if (push.cut_only != 0 && !path.cut) return;
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
  if (push.last != 0) {
    if (push.orders > 1 && !path.cut) add_higher_orders(path, inscatter, ground);
    columns_along(path.altitude_km, path.mu, path.length_km, column);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      WRITE(tile, (TRANSMITTANCE * GROUPS + g) * n + i, transmittance_of(column, g));
    }
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= view_share[c];
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (push.last != 0) ground[g] = ground_seen(ground[g], transmittance_of(column, g));
    WRITE(tile, (INSCATTER * GROUPS + g) * n + i, inscatter[g]);
    WRITE(tile, (GROUND * GROUPS + g) * n + i, ground[g]);
  }
}
