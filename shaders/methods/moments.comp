#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_view.glsl"
Real view_share[MEDIA_SIZE];
#define VIEW_SHARE(c) view_share[c]
#include "methods/raymarch.glsl"

// A pixel: order one by the march, what was scattered more than once from the sky's table, and the
// ground under the light of the whole sky.
layout(std430, binding = OWN + 2) restrict readonly buffer SkyBuffer { Vec4 sky[]; };
layout(std430, binding = OWN + 3) restrict buffer TileBuffer { Vec4 tile[]; };
// How far along each ray the march has come under the present sun, km.
layout(std430, binding = OWN + 4) restrict buffer ProgressBuffer { Real progress_km[]; };

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
} push;

CONSTANT int AUREOLE_NODES = 129;

// The aureole's function, by the fourth root of (1 - nu) / 2.
Vec4 aureole_towards(ScatteringAngle angle, int g) {
  Real node = sqrt(sqrt(max(0.5 * angle.one_minus_cosine, 0.0))) * Real(AUREOLE_NODES - 1);
  int low = min(int(node), AUREOLE_NODES - 2);
  return mix(aureole(low, g), aureole(low + 1, g), node - Real(low));
}

struct SkyPlace {
  int at;          // of the lower elevation's and azimuth's values
  Real elevation, azimuth;
};

SkyPlace sky_place(Path path, Vec3 axis) {
  SkyPlace place;
  Real elevation = elevation_share(path.direction, path.meets_ground) * Real(push.elevations - 1);
  Real azimuth = azimuth_from(axis_forward(axis), path.direction) / PI * Real(push.azimuths - 1);
  int e = min(int(elevation), push.elevations - 2);
  int a = clamp(int(azimuth), 0, push.azimuths - 2);
  place.elevation = elevation - Real(e);
  place.azimuth = azimuth - Real(a);
  place.at = ((e + (path.meets_ground ? push.elevations : 0)) * push.azimuths + a) * 2 * GROUPS;
  return place;
}

Vec4 sky_value(SkyPlace place, int offset) {
  int at = place.at + offset;
  int up = push.azimuths * 2 * GROUPS;
  return mix(mix(sky[at], sky[at + 2 * GROUPS], place.azimuth),
             mix(sky[at + up], sky[at + up + 2 * GROUPS], place.azimuth), place.elevation);
}

void add_higher_orders(Path path, INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE),
                       INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  Vec3 axis = sun_axis();
  if (path.length_km > 0.0) {
    SkyPlace place = sky_place(path, axis);
    ScatteringAngle angle =
        scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 light = exp(sky_value(place, g));
      if (PARTICLES) {
        light = light * max(1.0 + sky_value(place, GROUPS + g) * aureole_towards(angle, g), 0.0);
      }
      inscatter[g] = inscatter[g] + light;
    }
  }
  if (path.meets_ground) {
    Vec3 position = path.start + path.direction * path.length_km;
    Real node = node_of_sun(push.grid, sun_range(push.grid, 0.0), dot(position, axis) / length(position)) /
                Real(push.grid.suns - 1) * Real(push.fine_suns - 1);
    int s = min(int(node), push.fine_suns - 2);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      int at = push.irradiance + s * GROUPS + g;
      ground[g] = ground[g] + lambertian(g) * exp(mix(moments[at], moments[at + GROUPS], node - Real(s)));
    }
  }
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int n = push.rays_in_tile;
  if (i >= n) return;
  load_scene();
  load_media();
  UNROLL for (int c = 0; c < MEDIA; ++c) view_share[c] = share_of_extinction(c);
  PixelRay pixel = pixel_ray(push.first_ray + i);
  Path path = path_from_camera(pixel.direction);
  if (!pixel.inside) {
    path.length_km = 0.0;
    path.meets_ground = false;
  }
  bool fresh = push.sun == 0 && push.first != 0;
  Vec4 inscatter[GROUPS];
  Vec4 ground[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    inscatter[g] = fresh ? Vec4(0.0) : tile[(INSCATTER * GROUPS + g) * n + i];
    ground[g] = fresh ? Vec4(0.0) : tile[(GROUND * GROUPS + g) * n + i];
  }
  Real from_km = push.first != 0 ? 0.0 : progress_km[i];
  march_towards(path, push.sun, push.view_nodes, push.pieces, from_km, inscatter);
  if (push.first != 0) light_ground_from(path, push.sun, ground);
  progress_km[i] = from_km;

  Real column[MEDIA_SIZE];
  if (push.last != 0) {
    if (push.orders > 1) add_higher_orders(path, inscatter, ground);
    columns_along(path.altitude_km, path.mu, path.length_km, column);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      tile[(TRANSMITTANCE * GROUPS + g) * n + i] = transmittance_of(column, g);
    }
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= view_share[c];
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    if (push.last != 0) ground[g] = ground[g] * transmittance_of(column, g);
    tile[(INSCATTER * GROUPS + g) * n + i] = inscatter[g];
    tile[(GROUND * GROUPS + g) * n + i] = ground[g];
  }
}
