#version 450
#extension GL_GOOGLE_include_directive : require
// Pixels from the sky view: interpolated ratios, exact columns, phase functions. From one of parts of rays
// those pixels alone whose rays end at something.
#include "device.glsl"
#include "methods/hillaire/constants.glsl"
#include "methods/hillaire/multiple_buffers.glsl"

layout(binding = OWN + 4, r32f) uniform restrict readonly imageBuffer view_columns;
layout(binding = OWN + 5, rgba32f) uniform restrict readonly imageBuffer sky_view;
layout(std430, binding = OWN + 6) restrict writeonly buffer TileBuffer { Vec4 tile[]; };

#include "methods/hillaire/view.glsl"
#include "methods/hillaire/sky_view.glsl"

layout(push_constant) uniform Push {
  int first;  // ray of the tile
  int end;
  int first_ray;  // of the tile, in the frame
  int rays_in_tile;
  int all_orders;
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
  Vec3 to_sun = sun_ray(path.start, Vec3(0.0)).direction;
  SunlitRay ray = view_ray(path, to_sun);
  Real azimuth_cosine = azimuth_cosine_between(path.direction, to_sun);
  SkyPosition position;

  Real column[MEDIA_SIZE];
  Vec4 once[MEDIA_GROUPS_SIZE];
  Vec4 further[GROUPS];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  Vec4 ground[GROUPS];
  if (SKY_VIEW_STOPS > 1) {
    if (!path.cut) return;
    SunlitRay whole = sunlit_ray(ray.altitude_km, ray.mu, meets_ground(ray.altitude_km, ray.mu),
                                 ray.mu_sun, ray.nu);
    position = part_position(whole, azimuth_cosine, ray.length_km);
    columns_along(ray.altitude_km, ray.mu, ray.length_km, column);
  } else {
    position = sky_position(ray, azimuth_cosine);
    view_columns_of(ray, column);
  }
  scattering_towards(scattering_angle(to_sun, path.direction), scattering_phase);
  light_ground(path, Vec3(0.0), push.all_orders != 0, ground);
  int planes = sky_planes();
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int plane = 0;
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      once[c * GROUPS + g] = Vec4(0.0);
      if (medium(c).phase == PHASE_NONE) continue;
      once[c * GROUPS + g] = interpolated_ratio(position, planes, plane, g);
      ++plane;
    }
    further[g] = interpolated_ratio(position, planes, plane, g);
    Vec4 transmittance = transmittance_of(column, g);
    tile[(INSCATTER * GROUPS + g) * n + i] =
        radiance_of(column, once, further, scattering_phase, g);
    tile[(GROUND * GROUPS + g) * n + i] = ground_seen(ground[g], transmittance);
    tile[(TRANSMITTANCE * GROUPS + g) * n + i] = true_transmittance(column, g);
  }
}
