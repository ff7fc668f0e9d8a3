#version 450
#extension GL_GOOGLE_include_directive : require
// Pixels by a march each: from outside the air, where a sky view would be too coarse, and under a near sun or
// one of several points, one of which a dispatch adds.
#define ANY_PROJECTION
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/multiple_buffers.glsl"

layout(binding = OWN + 4, r32f) uniform restrict readonly imageBuffer view_columns;
layout(binding = OWN + 5, rgba32f) uniform restrict imageBuffer tile;

#include "methods/hillaire/view.glsl"

layout(push_constant) uniform Push {
  int first;  // ray of the tile
  int end;
  int first_ray;  // of the tile, in the frame
  int rays_in_tile;
  int all_orders;
  int samples;
  int sun;  // point of the disc
  float scale_height_km;
  int cut_only;  // 1: rays that end at something alone
} push;

void main() {
  load_scene();
  load_media();
  int i = push.first + int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= push.end) return;
  take_out_forward_peak();
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  if (push.cut_only != 0 && !path.cut) return;
  Vec3 offset = MANY_SUNS ? sun_offset(push.sun) : Vec3(0.0);
  Vec3 to_sun = sun_ray(path.start, offset).direction;
  SunlitRay ray = view_ray(path, to_sun);

  Real column[MEDIA_SIZE];
  Vec4 once[MEDIA_GROUPS_SIZE];
  Vec4 further[GROUPS];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  Vec4 ground[GROUPS];
  march_view(ray, path, push.sun, push.samples, push.scale_height_km, push.all_orders != 0, column,
             once, further);
  make_ratios(column, once, further);
  if (!path.cut) view_columns_of(ray, column);
  scattering_towards(scattering_angle(to_sun, path.direction), scattering_phase);
  light_ground(path, offset, push.all_orders != 0, ground);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 transmittance = transmittance_of(column, g);
    Vec4 share = MANY_SUNS ? sun_weight(push.sun, g) : Vec4(1.0);
    Vec4 inscatter = radiance_of(column, once, further, scattering_phase, g) * share;
    Vec4 reflected = ground_seen(ground[g], transmittance) * share;
    if (push.sun > 0) {
      inscatter = inscatter + READ(tile, (INSCATTER * GROUPS + g) * n + i);
      reflected = reflected + READ(tile, (GROUND * GROUPS + g) * n + i);
    }
    WRITE(tile, (INSCATTER * GROUPS + g) * n + i, inscatter);
    WRITE(tile, (GROUND * GROUPS + g) * n + i, reflected);
    WRITE(tile, (TRANSMITTANCE * GROUPS + g) * n + i, true_transmittance(column, g));
  }
}
