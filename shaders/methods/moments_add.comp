#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_view.glsl"

// Adds to pixels that have order one already what was scattered more than once.
layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer sky;
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer tile;

layout(push_constant) uniform Push {
  MomentGrid grid;
  int irradiance;      // where it lies behind the moments
  int fine_suns;
  int elevations, azimuths;
  int first_ray;       // of the tile, in the frame
  int rays_in_tile;
} push;

const int SKY_VALUES = 2 * GROUPS;
#include "methods/moments_pixel.glsl"

void main() {
  load_scene();
  load_media();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  if (path.cut || !meets_planet(path)) return;
  Vec4 inscatter[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = READ(tile, (INSCATTER * GROUPS + g) * n + i);
    ground[g] = Vec4(0.0);
  }
  add_higher_orders(path, inscatter, ground);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, path.length_km, column);
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= share_of_extinction(c);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    WRITE(tile, (INSCATTER * GROUPS + g) * n + i, inscatter[g]);
    int to = (GROUND * GROUPS + g) * n + i;
    WRITE(tile, to, READ(tile, to) + ground_seen(ground[g], transmittance_of(column, g)));
  }
}
