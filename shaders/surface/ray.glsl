// Where rays meet a ground that has heights, and which of its points the sun reaches. Heights are looked at no
// finer than a pixel is wide there.

// What a pixel is wide at a distance from the camera, km.
Real pixel_width_km(Real distance_km) { return scene.pixel_rad * distance_km; }

// Above the sphere of the ground, under a point (km, the planet's centre at the origin).
Real surface_height_km(Vec3 position, Real footprint_km) {
  return height_of_ground_km(position / length(position), footprint_km);
}

// Distances along a path between which it may meet heights.
struct HeightsPart {
  Real from_km;
  Real to_km;
};

HeightsPart among_heights(Path path) {
  HeightsPart part;
  Real relief = surface_relief_km();
  Real b = (scene.planet_radius_km + path.altitude_km) * path.mu;
  Real c = (path.altitude_km - relief) * (2.0 * scene.planet_radius_km + path.altitude_km + relief);
  Real d = b * b - c;
  part.from_km = 0.0;
  part.to_km = 0.0;
  if (d <= 0.0 || (c > 0.0 && b >= 0.0)) return part;
  Real root = sqrt(d);
  if (c > 0.0) part.from_km = c / (root - b);
  Real leaves = b > 0.0 ? -c / (root + b) : root - b;
  part.to_km = path.meets_ground ? path.length_km : min(leaves, path.length_km);
  return part;
}

CONSTANT int MOST_VIEW_STEPS = 400;
CONSTANT int MOST_SUN_STEPS = 192;
CONSTANT int HALVINGS = 10;
CONSTANT Real LEAST_STEP_KM = 1e-4;

// Distance of the ground along a path, from the path's start; ENDLESS where there is none. `before_km`: from
// the camera to the start. Steps become longer with the gap below them, and once one has ended under the
// ground are halved, all in one loop: the code of heights is there once.
Real distance_to_surface(Path path, Real before_km) {
  Real sphere_km = path.meets_ground ? path.length_km : ENDLESS;
  if (surface_relief_km() <= 0.0) return sphere_km;
  HeightsPart part = among_heights(path);
  Real above_km = part.from_km;
  Real below_km = ENDLESS;
  // Whoever lies on the ground itself looks out of it, not at it: rounding does not decide that.
  Real t = max(part.from_km, LEAST_STEP_KM);
  int halvings = 0;
  for (int i = 0; i < MOST_VIEW_STEPS && t < part.to_km && halvings <= HALVINGS; ++i) {
    Real width_km = pixel_width_km(before_km + t);
    Real gap_km = altitude_after(path.altitude_km, path.mu, t) -
                  surface_height_km(path.start + path.direction * t, width_km);
    if (gap_km > 0.0) {
      above_km = t;
      t += max(max(0.6 * gap_km, 0.5 * width_km), 0.007 * t + LEAST_STEP_KM);
    } else {
      below_km = t;
    }
    if (below_km < ENDLESS) {
      t = 0.5 * (above_km + below_km);
      ++halvings;
    }
  }
  // A ray that has skimmed the ground for so many steps counts as having met it.
  return below_km < ENDLESS || t < part.to_km ? t : sphere_km;
}

// The share of the sun's disc that heights leave to be seen from a point at an altitude. `width_km`: what is
// looked at.
Real sun_over_heights(Vec3 position, Real altitude_km, Vec3 to_sun, Real width_km) {
  if (surface_relief_km() <= 0.0) return 1.0;
  Path path;
  path.start = position;
  path.direction = to_sun;
  path.altitude_km = altitude_km;
  path.mu = dot(position, to_sun) / length(position);
  path.length_km = distance_to_top(altitude_km, path.mu);
  path.meets_ground = false;
  HeightsPart part = among_heights(path);
  Real least = 1.0;  // gap over what half of the sun spans there
  Real t = max(part.from_km, width_km);
  for (int i = 0; i < MOST_SUN_STEPS && t < part.to_km; ++i) {
    Real there_km = max(width_km, 0.002 * t);
    Real gap_km = altitude_after(altitude_km, path.mu, t) -
                  surface_height_km(position + to_sun * t, there_km);
    least = min(least, gap_km / (t * max(scene.sun_sin_radius, 1e-4)));
    if (least <= -1.0) break;
    t += max(0.5 * abs(gap_km), max(0.5 * width_km, 0.002 * t));
  }
  return clamp(0.5 + 0.5 * least, 0.0, 1.0);
}

// Unit vector that stands on the ground at a point.
Vec3 surface_normal(Vec3 position, Real width_km) {
  Real r = length(position);
  Vec3 up = position / r;
  if (surface_relief_km() <= 0.0) return up;
  Real step_km = max(width_km, 2e-6 * scene.planet_radius_km);
  Vec3 side = abs(up.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(1.0, 0.0, 0.0);
  Vec3 across = normalize(cross(side, up));
  Vec3 along = cross(up, across);
  Real height[3];
  for (int i = 0; i < 3; ++i) {
    Vec3 there = position;
    if (i == 1) there = position + across * step_km;
    if (i == 2) there = position + along * step_km;
    height[i] = surface_height_km(there, width_km);
  }
  return normalize(up - (across * (height[1] - height[0]) + along * (height[2] - height[0])) /
                            step_km);
}
