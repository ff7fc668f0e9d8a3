// Where the tables of Hillaire's method [2020] keep what. Every mapping puts its ends on texels, so nothing
// is extrapolated, and none needs an angle: built-in arc functions are wrong by 1e-4 on some devices.

// Sine of the dip of the horizon seen from the top: with the sun lower than that, it lights no air above
// a place. The unit in which day turns to night, on any planet.
Real twilight_sine() {
  return sqrt(squared_height(scene.thickness_km)) /
         (scene.planet_radius_km + scene.thickness_km);
}

// Cosines of the sun, uniform in asinh((mu_s - c) / w): c in the middle of twilight, w half of its length.
Real stretched_sun(Real mu_sun) { return asinh((mu_sun / twilight_sine() + 0.3) / 0.5); }

Real table_sun_coordinate(Real mu_sun) {
  Real low = stretched_sun(-1.0);
  return clamp((stretched_sun(mu_sun) - low) / (stretched_sun(1.0) - low), 0.0, 1.0);
}

Real sun_cosine_at(Real x) {
  Real stretched = mix(stretched_sun(-1.0), stretched_sun(1.0), x);
  return clamp((0.5 * sinh(stretched) - 0.3) * twilight_sine(), -1.0, 1.0);
}

// Altitudes, closer together next to the ground.
Real table_altitude_coordinate(Real h) { return sqrt(clamp(h / scene.thickness_km, 0.0, 1.0)); }
Real altitude_at(Real y) { return y * y * scene.thickness_km; }

// From the horizon (0) to the zenith or the nadir (1), uniform in the square root of the difference of
// cosines: about the horizon lengths of paths change like that [Hillaire 2020, section 5.3].
Real elevation_coordinate(Real h, Real mu, bool meets_ground) {
  Real horizon = horizon_cosine(h);
  Real x = meets_ground ? (horizon - mu) / (1.0 + horizon) : (mu - horizon) / (1.0 - horizon);
  return sqrt(clamp(x, 0.0, 1.0));
}

Real elevation_cosine_at(Real h, Real x, bool meets_ground) {
  Real horizon = horizon_cosine(h);
  return meets_ground ? horizon - x * x * (1.0 + horizon) : horizon + x * x * (1.0 - horizon);
}

// A place between two neighbours of a row of nodes.
struct NodePosition {
  int node;  // the lower one
  Real fraction;
};

NodePosition node_position(Real x, int nodes) {
  NodePosition position;
  Real place = x * Real(nodes - 1);
  position.node = min(int(place), nodes - 2);
  position.fraction = place - Real(position.node);
  return position;
}
