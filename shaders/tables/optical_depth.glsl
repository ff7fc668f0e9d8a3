// Optical depth to the top of the air, tabulated over the zenith cosine and the altitude of a ray that
// does not meet the ground [Bruneton 2017, section "Transmittance", "Precomputation"]. The depth itself
// is kept, not its exponential: it is smooth where the transmittance is not, and never underflows.
//
// Across (u): the distance to the top, from its shortest (straight up) to its longest (to the horizon).
// Up (v): the distance to the horizon, from the ground's to the top's. Both ends of both are texels, so
// nothing is extrapolated.

struct OpticalDepthRay {
  Real altitude_km;
  Real mu;  // zenith cosine
};

Vec2 optical_depth_coordinates(Real h, Real mu) {
  Real top = scene.thickness_km;
  Real horizon_km = sqrt(squared_height(h));
  Real longest_horizon_km = sqrt(squared_height(top));
  Real shortest_km = top - h;
  Real longest_km = horizon_km + longest_horizon_km;
  Real u = (distance_to_top(h, mu) - shortest_km) / (longest_km - shortest_km);
  return Vec2(clamp(u, 0.0, 1.0), clamp(horizon_km / longest_horizon_km, 0.0, 1.0));
}

// The ray at coordinates in [0, 1]; its squared heights are differences of squares of the distances that
// the coordinates are made of, so nothing cancels next to the ground.
OpticalDepthRay optical_depth_ray(Vec2 at) {
  OpticalDepthRay ray;
  Real radius = scene.planet_radius_km;
  Real top = scene.thickness_km;
  Real longest_horizon_km = sqrt(squared_height(top));
  Real horizon_km = at.y * longest_horizon_km;
  Real squared = horizon_km * horizon_km;
  ray.altitude_km = min(squared / (sqrt(radius * radius + squared) + radius), top);
  Real shortest_km = top - ray.altitude_km;
  Real to_top_km = mix(shortest_km, horizon_km + longest_horizon_km, at.x);
  ray.mu = 1.0;
  if (to_top_km > 0.0) {
    Real above = shortest_km * (2.0 * radius + top + ray.altitude_km);
    ray.mu = (above - to_top_km * to_top_km) /
             (2.0 * (radius + ray.altitude_km) * to_top_km);
  }
  ray.mu = clamp(ray.mu, -1.0, 1.0);
  return ray;
}

// The texels about a ray: found once, read for every group of wavelengths.
struct OpticalDepthPosition {
  int texel;  // the lower left one
  Real across;
  Real up;
};

OpticalDepthPosition optical_depth_position(Real h, Real mu) {
  OpticalDepthPosition position;
  Vec2 at = optical_depth_coordinates(h, mu);
  Real x = at.x * Real(OPTICAL_DEPTH_COSINES - 1);
  Real y = at.y * Real(OPTICAL_DEPTH_ALTITUDES - 1);
  int column = min(int(x), OPTICAL_DEPTH_COSINES - 2);
  int row = min(int(y), OPTICAL_DEPTH_ALTITUDES - 2);
  position.texel = row * OPTICAL_DEPTH_COSINES + column;
  position.across = x - Real(column);
  position.up = y - Real(row);
  return position;
}

// Bilinear; of a group of wavelengths.
Vec4 tabulated_optical_depth(OpticalDepthPosition position, int group) {
  int low = position.texel;
  int high = low + OPTICAL_DEPTH_COSINES;
  return mix(mix(READ(optical_depths, low * GROUPS + group),
                 READ(optical_depths, (low + 1) * GROUPS + group), position.across),
             mix(READ(optical_depths, high * GROUPS + group),
                 READ(optical_depths, (high + 1) * GROUPS + group), position.across),
             position.up);
}
