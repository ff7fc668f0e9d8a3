// What the proposals know of the scene (engine/methods/path/guide.h).
//
// A scale height of what scatters; the share of directions that are drawn about the sun; by constituent
// its share in these; for tabulated phases the edges of cells in 1 - cos. Where GUIDED, also the light
// that there is for a walk to find, estimated coarsely for isotropic scattering at one wavelength,
// by altitude and zenith cosine of the sun: how much scatters at a point, how much arrives there by
// scattering, and from which directions.
CONSTANT int PHASE_CELLS = 128;
CONSTANT int LIGHT_ALTITUDES = 48;   // of the light that scatters at a point
CONSTANT int LIGHT_SUNS = 128;
CONSTANT int SKY_ALTITUDES = 12;     // of the light that arrives by scattering
CONSTANT int SKY_SUNS = 32;
CONSTANT int SKY_ELEVATIONS = 16;
CONSTANT int SKY_AZIMUTHS = 6;
CONSTANT int SKY_CELLS = SKY_ELEVATIONS * SKY_AZIMUTHS;

Real guide_scale_height_km() { return READ_REAL(path_guide, 0); }
Real guide_sun_share() { return READ_REAL(path_guide, 1); }
Real guide_peak_share(int c) { return READ_REAL(path_guide, 2 + c); }
Real phase_cell_edge(int c, int edge) { return READ_REAL(path_guide, 2 + MEDIA + c * (PHASE_CELLS + 1) + edge); }
int light_offset() { return 2 + MEDIA + MEDIA * (PHASE_CELLS + 1); }
int sky_offset() { return light_offset() + LIGHT_ALTITUDES * LIGHT_SUNS; }
Real sky_light(int place) { return READ_REAL(path_guide, sky_offset() + place); }
// Share of the cells before a cell in the sky of a place.
Real sky_share_before(int place, int cell) {
  return READ_REAL(path_guide, sky_offset() + SKY_ALTITUDES * SKY_SUNS + place * (SKY_CELLS + 1) + cell);
}

// Coordinates from 0 to 1. Suns are spread about the angle at which the shell's shadow ends.
Real altitude_coordinate(Real h) { return sqrt(max(h, 0.0) / scene.thickness_km); }
Real sun_coordinate(Real mu_sun) {
  Real radius = scene.planet_radius_km + scene.thickness_km;
  Real dip = sqrt(squared_height(scene.thickness_km)) / radius;
  Real lowest = inverse_sinh(-4.0);
  Real highest = inverse_sinh(2.0 / dip + 0.5);
  return clamp((inverse_sinh(2.0 * mu_sun / dip + 0.5) - lowest) / (highest - lowest), 0.0, 1.0);
}

int light_place(Real h, Real mu_sun) {
  int i = clamp(int(altitude_coordinate(h) * Real(LIGHT_ALTITUDES)), 0, LIGHT_ALTITUDES - 1);
  int j = clamp(int(sun_coordinate(mu_sun) * Real(LIGHT_SUNS)), 0, LIGHT_SUNS - 1);
  return i * LIGHT_SUNS + j;
}

int sky_place(Real h, Real mu_sun) {
  int i = clamp(int(altitude_coordinate(h) * Real(SKY_ALTITUDES)), 0, SKY_ALTITUDES - 1);
  int j = clamp(int(sun_coordinate(mu_sun) * Real(SKY_SUNS)), 0, SKY_SUNS - 1);
  return i * SKY_SUNS + j;
}
