// Rays through a spherical shell. A point is its altitude h above the ground, never its distance from
// the centre: with a radius of 6360 km one float ulp of that distance is 0.5 m, of 1e6 km it is 62 m.
// mu is the cosine of the angle between a direction and the vertical at the ray's start.

// (R + h)^2 - R^2, without the cancellation.
Real squared_height(Real h) { return h * (2.0 * scene.planet_radius_km + h); }

// Altitude at the distance t along a ray that starts at the altitude h.
Real altitude_after(Real h, Real mu, Real t) {
  Real radius = scene.planet_radius_km;
  Real d = max(squared_height(h) + t * (2.0 * (radius + h) * mu + t), 0.0);
  return d / (sqrt(radius * radius + d) + radius);
}

// Whether the ray comes to the ground; a ray that starts on it and goes down meets it at 0.
bool meets_ground(Real h, Real mu) {
  Real b = (scene.planet_radius_km + h) * mu;
  return mu < 0.0 && b * b >= squared_height(h);
}

// Cosine of the horizon's zenith angle: rays above it miss the ground.
Real horizon_cosine(Real h) {
  return -sqrt(squared_height(h)) / (scene.planet_radius_km + h);
}

// Distance to the ground, for a ray that meets it: c / (-b + sqrt(b^2 - c)), exact near the ground.
Real distance_to_ground(Real h, Real mu) {
  Real b = (scene.planet_radius_km + h) * mu;
  Real c = squared_height(h);
  // On the ground along the horizon both are 0, and so is the distance.
  return c / max(sqrt(max(b * b - c, 0.0)) - b, 1e-30);
}

// Distance from a point inside the shell to its top, as if the ground weren't there.
Real distance_to_top(Real h, Real mu) {
  Real b = (scene.planet_radius_km + h) * mu;
  Real top = scene.thickness_km;
  Real c = max((top - h) * (2.0 * scene.planet_radius_km + top + h), 0.0);
  Real root = sqrt(b * b + c);
  return b > 0.0 ? c / (root + b) : root - b;
}

// The part of a ray that lies inside the shell.
struct Path {
  Vec3 start;          // km, the planet's centre at the origin; for directions only
  Vec3 direction;
  Real altitude_km;    // of the start
  Real mu;             // zenith cosine there
  Real length_km;      // 0 where the ray meets neither air nor ground
  bool meets_ground;
  bool cut;            // something stands at its end, in the air or beyond it
};

// From a camera at the altitude h above the origin of the local frame.
Path path_from_camera(Vec3 direction) {
  Path path;
  Real h = scene.camera_altitude_km;
  Real r = scene.planet_radius_km + h;
  Real r_top = scene.planet_radius_km + scene.thickness_km;
  path.start = Vec3(0.0, 0.0, r);
  path.direction = direction;
  path.altitude_km = h;
  path.mu = direction.z;
  path.length_km = 0.0;
  path.meets_ground = false;
  path.cut = false;
  if (h > scene.thickness_km) {
    // The distance of closest approach, from the horizontal part of the direction: that keeps its
    // relative precision where a planet seen from afar fills a small angle.
    Real closest = r * length(Vec2(direction.x, direction.y));
    if (direction.z >= 0.0 || closest >= r_top) return path;
    Real half_chord = sqrt((r_top - closest) * (r_top + closest));
    path.start = path.start + direction * (-r * direction.z - half_chord);
    path.altitude_km = scene.thickness_km;
    path.mu = -half_chord / r_top;
  }
  path.meets_ground = meets_ground(path.altitude_km, path.mu);
  path.length_km = path.meets_ground ? distance_to_ground(path.altitude_km, path.mu)
                                     : distance_to_top(path.altitude_km, path.mu);
  return path;
}

// Whether a ray from the camera meets air or ground at all.
bool meets_planet(Path path) { return path.length_km > 0.0 || path.meets_ground; }
