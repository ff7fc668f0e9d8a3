#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_view.glsl"
#include "methods/moments_parts.glsl"

// Adds to pixels whose rays end at something, and that have order one already, what was scattered more than once.
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

const int SKY_VALUES = PART_STOPS * 2 * GROUPS;
#include "methods/moments_pixel.glsl"

void main() {
  load_scene();
  load_media();
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_of_ray(push.first_ray + i, pixel);
  if (!path.cut) return;
  bool down = meets_ground(path.altitude_km, path.mu);
  Real whole_km = down ? distance_to_ground(path.altitude_km, path.mu)
                       : distance_to_top(path.altitude_km, path.mu);
  Real stop = stop_coordinate(stops_of(path.altitude_km, path.mu, whole_km), path.length_km,
                              PART_STOPS);
  int low = min(int(stop), PART_STOPS - 2);
  SkyPlace place = sky_place(path.direction, down, sun_axis());
  ScatteringAngle angle =
      scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction);
  Real column[MEDIA_SIZE];
  columns_along(path.altitude_km, path.mu, path.length_km, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int at = low * 2 * GROUPS + g;
    Real share = stop - Real(low);
    Vec4 light = light_of_logarithm(
        mix(sky_value(place, at), sky_value(place, at + 2 * GROUPS), share));
    if (PARTICLES) {
      Vec4 aureole_light =
          mix(sky_value(place, at + GROUPS), sky_value(place, at + 3 * GROUPS), share);
      light = light * max(1.0 + aureole_light * aureole_towards(angle, g), 0.0);
    }
    int to = (INSCATTER * GROUPS + g) * n + i;
    WRITE(tile, to, READ(tile, to) + light * part_scattered(column, g));
  }
  if (!ends_on_ground(path)) return;
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) ground[g] = Vec4(0.0);
  add_sky_on_ground(path, ground);
  UNROLL for (int g = 0; g < GROUPS; ++g) WRITE(tile, (GROUND * GROUPS + g) * n + i, ground[g]);
}
