// The light of a path's first part is the difference of what is seen from both its ends [Bruneton and
// Neyret 2008, section 4, aerial perspective]: S(p) - T(p, q) S(q).

// The rest of the same ray: it goes on to meet the ground where the whole does.
Path path_beyond(Path path, Real t) {
  Path rest;
  Real r = scene.planet_radius_km + path.altitude_km;
  rest.start = path.start + path.direction * t;
  rest.direction = path.direction;
  rest.altitude_km = min(altitude_after(path.altitude_km, path.mu, t), scene.thickness_km);
  rest.mu = clamp((r * path.mu + t) / (scene.planet_radius_km + rest.altitude_km), -1.0, 1.0);
  rest.length_km = max(path.length_km - t, 0.0);
  rest.meets_ground = path.meets_ground;
  return rest;
}
