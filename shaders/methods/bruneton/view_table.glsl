// Where a ray that comes into the air, or begins in it, lies in a table over the grid of rays.

// Neighbours that have to be read: none beside the one of a table for one sun, or one altitude.
layout(constant_id = 11) const int VIEW_SUNS = 2;
layout(constant_id = 12) const int VIEW_ALTITUDES = 2;

struct ViewPosition {
  Between altitude;
  Between zenith;
  Between azimuth;
  Between sun;
};

Vec3 towards_sun() {
  return Vec3(scene.sun_direction.x, scene.sun_direction.y, scene.sun_direction.z);
}

ViewPosition view_position(Path path) {
  ViewPosition position;
  Vec3 sun = towards_sun();
  Real mu_s = clamp(dot(path.start, sun) / length(path.start), -1.0, 1.0);
  Real sine = sqrt(max(1.0 - path.mu * path.mu, 0.0));
  Real cos_azimuth = azimuth_cosine(path.mu, sine, mu_s, dot(path.direction, sun));
  position.altitude = between(
      node_coordinate(altitude_share(grid, path.altitude_km), grid.altitudes), grid.altitudes);
  position.zenith = between(
      zenith_coordinate(grid, path.altitude_km, path.mu, path.meets_ground), grid.zeniths);
  position.azimuth = between(acos(cos_azimuth) / PI * Real(grid.azimuths - 1), grid.azimuths);
  position.sun = between_suns(grid, mu_s);
  if (VIEW_SUNS == 1) {
    position.sun.node = 0;
    position.sun.share = 0.0;
  }
  if (VIEW_ALTITUDES == 1) {
    position.altitude.node = 0;
    position.altitude.share = 0.0;
  }
  return position;
}

int view_texel(ViewPosition at, int altitude, int sun) {
  int place = (at.altitude.node + altitude) * grid.suns + at.sun.node + sun;
  return (place * grid.zeniths + at.zenith.node) * grid.azimuths + at.azimuth.node;
}
