// Light scattered more than once, isotropic, at an altitude under a sun; and the ground's diffuse irradiance
// under a sun. Per unit irradiance of the sun, 1/sr and 1. Both fall by decades in twilight, so their
// logarithms are tabulated and interpolated.

struct MultiplePosition {
  NodePosition sun;
  NodePosition altitude;
};

MultiplePosition multiple_position(Real h, Real mu_sun) {
  MultiplePosition position;
  position.sun = node_position(table_sun_coordinate(mu_sun), MULTIPLE_SUNS);
  position.altitude = node_position(table_altitude_coordinate(h), MULTIPLE_ALTITUDES);
  return position;
}

Vec4 multiple_scattering(MultiplePosition position, int group) {
  int low = position.altitude.node * MULTIPLE_SUNS + position.sun.node;
  int high = low + MULTIPLE_SUNS;
  return exp(mix(mix(READ(log_multiple, low * GROUPS + group), READ(log_multiple, (low + 1) * GROUPS + group),
                     position.sun.fraction),
                 mix(READ(log_multiple, high * GROUPS + group),
                     READ(log_multiple, (high + 1) * GROUPS + group), position.sun.fraction),
                 position.altitude.fraction));
}

Vec4 diffuse_irradiance(Real mu_sun, int group) {
  NodePosition sun = node_position(table_sun_coordinate(mu_sun), MULTIPLE_SUNS);
  return exp(mix(READ(log_irradiance, sun.node * GROUPS + group),
                 READ(log_irradiance, (sun.node + 1) * GROUPS + group), sun.fraction));
}
