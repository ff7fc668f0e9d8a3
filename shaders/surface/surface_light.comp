#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "device.glsl"
layout(constant_id = 10) const int SURFACE_KIND = 0;
#include "surface/surface.glsl"

// Lights the ground that the rays of a tile meet. A method has left there the sky's irradiance on a horizontal
// plane at the height of the sea, or, if it reflects by itself, all of the ground's light but that of the sun;
// here it becomes radiance as the camera sees it. An invocation is a ray.
//
// Tables know ground of one albedo a. What they find over another is linear in the light that leaves the ground,
// L(a) = L(0) + a G / (1 - a s), so of two of them, over black ground and over ground of the mean albedo,
// the light over ground of any albedo follows; s, what the air sends back of that light, from the irradiances
// of both. Which albedo that is a neighbourhood of some heights of the air tells.
layout(binding = OWN, rgba32f) uniform restrict imageBuffer tile;
layout(binding = OWN + 1, r32f) uniform restrict readonly imageBuffer distances_km;
// The same tile over black ground; idle where no tables are interpolated.
layout(binding = OWN + 2, rgba32f) uniform restrict readonly imageBuffer black;

const int LEFT_ORDER_ONE = 0;  // what the method leaves: nothing but what the sun itself does,
const int LEFT_WALKS = 1;      // what it has reflected,
const int LEFT_TABLES = 2;     // or what two of its tables say

layout(push_constant) uniform Push {
  int first;          // of this dispatch
  int end;
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int left;
} push;

const Real NEIGHBOURHOOD = 4.0;  // heights of the air

Vec4 inscatter_over(Vec4 over_black, Vec4 over_mean, Vec4 share) {
  return max(over_black + (over_mean - over_black) * share, Vec4(0.0));
}

// The sky's light on a height over that at the sea: in proportion to what is scattered above, once.
Vec4 share_of_sky(ARRAY(Real, above, MEDIA_SIZE), ARRAY(Real, all, MEDIA_SIZE), int group) {
  Vec4 depth_above = Vec4(0.0);
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    depth_above = depth_above + scattering(c, group) * above[c];
    depth = depth + scattering(c, group) * all[c];
  }
  return (1.0 - exp(-depth_above)) / max(1.0 - exp(-depth), Vec4(1e-9));
}

void main() {
  load_scene();
  load_media();
  int i = push.first + int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= push.end) return;
  int ray = push.first_ray + i;
  Path path = path_of_ray(ray, pixel_ray(ray));
  Real distance_km = READ_REAL(distances_km, ray);
  // What a client's picture shows in front hides the ground.
  bool hidden = distance_km >= ENDLESS || end_of_ray(ray) < distance_km * (1.0 - 1e-6);

  // Two looks at the ground: in the neighbourhood of the ray's lowest point, and where the ray ends.
  Real lowest_km = clamp(-(scene.planet_radius_km + path.altitude_km) * path.mu, 0.0, path.length_km);
  Real width_km = pixel_width_km(distance_km);
  Real around[MATTERS];
  Real share[MATTERS];
  Real altitude_km = 0.0;
  for (int look = 0; look < (hidden ? 1 : 2); ++look) {
    Real at_km = look == 0 ? lowest_km : path.length_km;
    UNROLL for (int m = 0; m < MATTERS; ++m) around[m] = look == 0 ? 0.0 : share[m];
    altitude_km = look_at_ground(normalize(path.start + path.direction * at_km),
                                 look == 0 ? NEIGHBOURHOOD * scene.view_scale_km : width_km, share);
  }
  if (hidden) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      WRITE(tile, (GROUND * GROUPS + g) * n + i, Vec4(0.0));
      if (push.left != LEFT_TABLES) continue;
      int at = (INSCATTER * GROUPS + g) * n + i;
      Vec4 of_mean = even_albedo(share, g) / max(ground_albedo(g), Vec4(1e-6));
      WRITE(tile, at, inscatter_over(READ(black, at), READ(tile, at), of_mean));
    }
    return;
  }

  Vec3 position = path.start + path.direction * path.length_km;
  GroundPlace place;
  place.up = position / length(position);
  place.normal = surface_normal(position, width_km);
  Vec4 beam[GROUPS];      // what the camera sees of the sun's light,
  Vec4 level[GROUPS];     // and what a horizontal plane gets of it
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    beam[g] = Vec4(0.0);
    level[g] = Vec4(0.0);
  }
  SunRay centre = sun_ray(position, Vec3(0.0));
  Real visible = sun_over_heights(position, altitude_km, centre.direction, width_km);
  for (int k = 0; k < scene.disc_points; ++k) {
    SunRay sun = sun_ray(position, MANY_SUNS ? sun_offset(k) : Vec3(0.0));
    Real mu_sun = dot(place.up, sun.direction);
    if (meets_ground(altitude_km, mu_sun) || (altitude_km <= 0.0 && mu_sun <= 0.0)) continue;
    Real column[MEDIA_SIZE];
    columns_to_top(altitude_km, mu_sun, column);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 light = transmittance_of(column, g) * sun.irradiance;
      if (MANY_SUNS) light = light * sun_weight(k, g);
      beam[g] = beam[g] +
                light * visible * reflected_beam(place, share, sun.direction, -path.direction, g);
      level[g] = level[g] + light * max(mu_sun, 0.0);
    }
  }
  Real above[MEDIA_SIZE];
  Real all[MEDIA_SIZE];
  columns_to_top(altitude_km, 1.0, above);
  columns_to_top(0.0, 1.0, all);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int at = (GROUND * GROUPS + g) * n + i;
    Vec4 transmittance = READ(tile, (TRANSMITTANCE * GROUPS + g) * n + i);
    if (push.left == LEFT_WALKS) {
      WRITE(tile, at, READ(tile, at) + beam[g] * transmittance);
      continue;
    }
    Vec4 sky = READ(tile, at);
    Vec4 nearby = even_albedo(around, g);
    if (push.left == LEFT_TABLES) {
      Vec4 mean = max(ground_albedo(g), Vec4(1e-6));
      Vec4 sent_back = clamp((1.0 - (level[g] + READ(black, at)) / max(level[g] + sky, Vec4(1e-20))) / mean,
                             Vec4(0.0), Vec4(0.95));
      Vec4 of_mean = nearby * (1.0 - mean * sent_back) / (mean * (1.0 - nearby * sent_back));
      sky = inscatter_over(READ(black, at), sky, of_mean);
      int inscatter = (INSCATTER * GROUPS + g) * n + i;
      WRITE(tile, inscatter, inscatter_over(READ(black, inscatter), READ(tile, inscatter), of_mean));
    }
    sky = sky * share_of_sky(above, all, g);
    Vec4 below = nearby * (sky + level[g]);
    Vec4 depth = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + scattering(c, g) * all[c];
    Real mirrored = mirrored_cosine(max(dot(place.up, -path.direction), 0.0));
    WRITE(tile, at, (beam[g] + reflected_sky(place, share, -path.direction, sky, below,
                                        brightness_of_sky(depth, mirrored), g)) *
               transmittance);
  }
}
