// Tables of what the first part of a ray sends, by where that part ends: at one of the ray's stops. They
// gather at its lowest point, where the air is densest: even in the cube root of the distance from there.

struct Stops {
  Real lowest_km;  // distance of the lowest point
  Real from;       // cube roots of the signed distances of start and end from there
  Real to;
};

Real cube_root(Real x) {
  Real root = abs(x) > 0.0 ? pow(abs(x), 1.0 / 3.0) : 0.0;
  return x < 0.0 ? -root : root;
}

// Of the whole ray, which is `length_km` long.
Stops stops_of(Real h, Real mu, Real length_km) {
  Stops stops;
  stops.lowest_km = clamp(-(scene.planet_radius_km + h) * mu, 0.0, length_km);
  stops.from = cube_root(-stops.lowest_km);
  stops.to = cube_root(length_km - stops.lowest_km);
  return stops;
}

// Distance of a stop. The first isn't quite at the start, where there would be nothing to divide by.
Real stop_km(Stops stops, int stop, int count) {
  Real share = max(Real(stop), 0.1) / Real(count - 1);
  Real root = stops.from + (stops.to - stops.from) * share;
  return stops.lowest_km + root * root * root;
}

// Its inverse, from 0 at the first stop to count - 1 at the last.
Real stop_coordinate(Stops stops, Real distance_km, int count) {
  Real root = cube_root(distance_km - stops.lowest_km);
  Real share = (root - stops.from) / max(stops.to - stops.from, 1e-9);
  return clamp(share, 0.0, 1.0) * Real(count - 1);
}
