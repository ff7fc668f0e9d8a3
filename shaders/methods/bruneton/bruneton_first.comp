#version 450
#extension GL_GOOGLE_include_directive : require
// Radiance of the first order along every ray of the grid, the sunlit ground with it, by the quadrature
// of raymarch. An invocation is a texel.
#include "device.glsl"
#include "methods/raymarch.glsl"
#include "methods/bruneton/tables.glsl"
layout(binding = FREE, rgba32f) uniform restrict imageBuffer radiances;
// How far along each ray the march has come, km.
layout(binding = FREE + 1, r32f) uniform restrict imageBuffer progress_km;

layout(push_constant) uniform Push {
  int first_texel;
  int end_texel;
  int view_nodes;
  int pieces;  // of this dispatch
  int first;   // dispatch of these texels
  int last;
} push;

// The ray of a texel; `scene` gets the texel's sun, at azimuth 0.
Path path_of(Texel texel) {
  Real mu_s = node_sun(texel.sun);
  scene.sun_direction = Vec4(direction_of(mu_s, 0.0), 0.0);
  Path path;
  path.altitude_km = node_altitude(texel.altitude);
  path.mu = node_cosine(texel.altitude, texel.zenith);
  path.start = Vec3(0.0, 0.0, scene.planet_radius_km + path.altitude_km);
  path.direction = direction_of(path.mu, node_azimuth(texel.azimuth));
  path.meets_ground = node_meets_ground(grid, path.altitude_km, texel.zenith, path.mu);
  path.length_km = path_length(path.altitude_km, path.mu, path.meets_ground);
  return path;
}

void main() {
  load_scene();
  load_media();
  load_grids();
  int offset = int(gl_GlobalInvocationID.x);
  int index = push.first_texel + offset;
  if (index >= push.end_texel) return;
  Path path = path_of(texel_at(index));
  Vec4 radiance[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    radiance[g] = push.first != 0 ? Vec4(0.0) : READ(radiances, g * texels() + index);
    ground[g] = Vec4(0.0);
  }
  Real from_km = push.first != 0 ? 0.0 : READ_REAL(progress_km, offset);
  march_towards(path, 0, push.view_nodes, push.pieces, from_km, radiance);
  WRITE_REAL(progress_km, offset, from_km);
  if (push.last != 0 && path.meets_ground) {
    light_ground_from(path, 0, ground);
    Real column[MEDIA_SIZE];
    columns_along(path.altitude_km, path.mu, path.length_km, column);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      radiance[g] = radiance[g] + ground[g] * transmittance_of(column, g);
    }
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) WRITE(radiances, g * texels() + index, radiance[g]);
}
