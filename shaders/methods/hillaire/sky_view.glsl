// The table of ratios over the directions of a camera in the air under parallel light: across, the cosine of
// the azimuth from the sun, from 1 to -1. All that a ray meets is a smooth function of that cosine, so the
// table has no seam towards the sun or away from it. Up, SKY_VIEW_ELEVATIONS / 2 rows from the horizon to the
// zenith, and the others from the horizon to the nadir; nothing is interpolated across the horizon. Of parts
// of rays there is such a table for each stop.

int sky_rows() { return SKY_VIEW_ELEVATIONS / 2; }
int ground_rows() { return SKY_VIEW_ELEVATIONS - sky_rows(); }

// Planes of a texel: one for each constituent that scatters, one for all further orders.
int sky_planes() {
  int planes = 1;
  UNROLL for (int c = 0; c < MEDIA; ++c) planes += medium(c).phase != PHASE_NONE ? 1 : 0;
  return planes;
}

struct SkyPosition {
  NodePosition azimuth;
  NodePosition elevation;  // its node counts rows of the whole table
  NodePosition stop;       // idle for whole rays
};

// Of a whole ray.
SkyPosition sky_position(SunlitRay ray, Real azimuth_cosine) {
  SkyPosition position;
  position.stop.node = 0;
  position.stop.fraction = 0.0;
  Real x = elevation_coordinate(ray.altitude_km, ray.mu, ray.meets_ground);
  position.azimuth =
      node_position(clamp(0.5 - 0.5 * azimuth_cosine, 0.0, 1.0), SKY_VIEW_AZIMUTHS);
  position.elevation = node_position(x, ray.meets_ground ? ground_rows() : sky_rows());
  if (ray.meets_ground) position.elevation.node += sky_rows();
  return position;
}

Stops stops_on(SunlitRay ray) { return stops_of(ray.altitude_km, ray.mu, ray.length_km); }

// Of the part of a ray that ends at a distance.
SkyPosition part_position(SunlitRay whole, Real azimuth_cosine, Real end_km) {
  SkyPosition position = sky_position(whole, azimuth_cosine);
  Real coordinate = stop_coordinate(stops_on(whole), end_km, SKY_VIEW_STOPS);
  position.stop.node = min(int(coordinate), max(SKY_VIEW_STOPS - 2, 0));
  position.stop.fraction = coordinate - Real(position.stop.node);
  return position;
}

// The ray of a texel: what lies at its elevation and azimuth under a sun of the zenith cosine mu_sun.
SunlitRay sky_ray(int column, int row, Real h, Real mu_sun) {
  bool ground = row >= sky_rows();
  Real x = ground ? Real(row - sky_rows()) / Real(ground_rows() - 1)
                  : Real(row) / Real(sky_rows() - 1);
  Real mu = elevation_cosine_at(h, x, ground);
  Real azimuth_cosine = 1.0 - 2.0 * Real(column) / Real(SKY_VIEW_AZIMUTHS - 1);
  Real sines = sqrt(max((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun), 0.0));
  return sunlit_ray(h, mu, ground, mu_sun, mu * mu_sun + sines * azimuth_cosine);
}

// Cosine of the azimuth between two directions; where one is vertical any value is right.
Real azimuth_cosine_between(Vec3 a, Vec3 b) {
  Real lengths = length(Vec2(a.x, a.y)) * length(Vec2(b.x, b.y));
  return lengths > 0.0 ? (a.x * b.x + a.y * b.y) / lengths : 1.0;
}

Vec4 ratio_at_stop(SkyPosition position, int stop, int planes, int plane, int group) {
  int row = stop * SKY_VIEW_ELEVATIONS + position.elevation.node;
  int low = ((row * SKY_VIEW_AZIMUTHS + position.azimuth.node) * planes + plane) * GROUPS + group;
  int high = low + SKY_VIEW_AZIMUTHS * planes * GROUPS;
  int next = planes * GROUPS;
  return mix(mix(READ(sky_view, low), READ(sky_view, low + next), position.azimuth.fraction),
             mix(READ(sky_view, high), READ(sky_view, high + next), position.azimuth.fraction),
             position.elevation.fraction);
}

Vec4 interpolated_ratio(SkyPosition position, int planes, int plane, int group) {
  Vec4 ratio = ratio_at_stop(position, position.stop.node, planes, plane, group);
  if (SKY_VIEW_STOPS == 1) return ratio;
  return mix(ratio, ratio_at_stop(position, position.stop.node + 1, planes, plane, group),
             position.stop.fraction);
}
