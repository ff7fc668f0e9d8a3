// What pixels add to order one: light that was scattered more than once, from the sky's table, and the ground
// under it. Declare the buffer `sky`, a push constant with its sizes, and SKY_VALUES, how many values
// it has a direction, before this.

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

SkyPlace sky_place(Vec3 direction, bool down, Vec3 axis) {
  SkyPlace place;
  Real elevation = elevation_share(direction, down) * Real(push.elevations - 1);
  Real azimuth = azimuth_from(axis_forward(axis), direction) / PI * Real(push.azimuths - 1);
  int e = min(int(elevation), push.elevations - 2);
  int a = clamp(int(azimuth), 0, push.azimuths - 2);
  place.elevation = elevation - Real(e);
  place.azimuth = azimuth - Real(a);
  place.at = ((e + (down ? push.elevations : 0)) * push.azimuths + a) * SKY_VALUES;
  return place;
}

Vec4 sky_value(SkyPlace place, int offset) {
  int at = place.at + offset;
  int up = push.azimuths * SKY_VALUES;
  return mix(mix(READ(sky, at), READ(sky, at + SKY_VALUES), place.azimuth),
             mix(READ(sky, at + up), READ(sky, at + up + SKY_VALUES), place.azimuth), place.elevation);
}

// What the ground makes of the diffuse light of all orders.
void add_sky_on_ground(Path path, INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  Vec3 axis = sun_axis();
  Vec3 position = path.start + path.direction * path.length_km;
  Real node = node_of_sun(push.grid, sun_range(push.grid, 0.0), dot(position, axis) / length(position)) /
              Real(push.grid.suns - 1) * Real(push.fine_suns - 1);
  int s = min(int(node), push.fine_suns - 2);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    int at = push.irradiance + s * GROUPS + g;
    Vec4 irradiance = light_of_logarithm(mix(READ(moments, at), READ(moments, at + GROUPS), node - Real(s)));
    ground[g] = ground[g] + left_by_ground(irradiance, g);
  }
}

void add_higher_orders(Path path, INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE),
                       INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  Vec3 axis = sun_axis();
  if (path.length_km > 0.0) {
    SkyPlace place = sky_place(path.direction, path.meets_ground, axis);
    ScatteringAngle angle =
        scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 light = light_of_logarithm(sky_value(place, g));
      if (PARTICLES) {
        light = light * max(1.0 + sky_value(place, GROUPS + g) * aureole_towards(angle, g), 0.0);
      }
      inscatter[g] = inscatter[g] + light;
    }
  }
  if (path.meets_ground) add_sky_on_ground(path, ground);
}
