// The cells of every ray of the grid, which all suns, azimuths and orders share. Define CELL_BINDING
// first. An entry is two vec4 of geometry and GROUPS of light; that after the last cell is the ray's
// end, with the transmittance to it.
layout(binding = CELL_BINDING, rgba32f) uniform restrict imageBuffer cell_values;

int cell_entry(int ray, int cells, int cell) {
  return (ray * (cells + 1) + cell) * (2 + GROUPS);
}

// A point of a ray, as its cells keep it.
struct RayPoint {
  Real altitude_coordinate, zenith_coordinate;  // of the source table
  Real distance_km;
  Real inverse_radius;  // 1/km
  Real mu, sine;        // of the ray's zenith angle there
};

RayPoint ray_point(int entry) {
  Vec4 a = READ(cell_values, entry);
  Vec4 b = READ(cell_values, entry + 1);
  RayPoint point;
  point.altitude_coordinate = a.x;
  point.zenith_coordinate = a.y;
  point.distance_km = a.z;
  point.inverse_radius = a.w;
  point.mu = b.x;
  point.sine = b.y;
  return point;
}
