// Continents and mountains of a procedural surface, by direction from the planet's centre in its own frame. Both
// are sums of octaves of one noise: plain for continents, ridged [Musgrave 1993] for mountains, where an
// octave is the stronger the higher the ridges of the one before. Octaves that are finer than what is
// looked at are left out, the last one faded, so nothing flickers and nothing pops.

CONSTANT Real FIRST_FREQUENCY = 1.7;  // of the planet's radius
CONSTANT int FIRST_RIDGES = 5;        // octave

struct Terrain {
  Real continent;  // 0 at the coast of half a world of seas; rises inland
  Real land;       // over the sea's level, the same unit
  Real height;     // over the sea, 0 to 1 of the relief
  Real octaves;    // that were looked at
  Real grain;      // of the ridges, about -0.5 to 0.5
};

// How many octaves are coarser than four footprints: what is made of them has edges, and of finer ones it would be
// a speckle of pixels.
Real octaves_down_to(Real footprint_km) {
  Real finest = 0.25 * scene.planet_radius_km / max(footprint_km, 1e-6);
  return clamp(log2(max(finest / FIRST_FREQUENCY, 1.0)) + 1.0, 2.0, Real(OCTAVES));
}

Real smooth_step(Real from, Real to, Real x) {
  Real t = clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// The lattices that a point on the unit sphere lies in, octave by octave: p = FIRST_FREQUENCY n, then p = 2 p +
// OCTAVE_SHIFT.
CONSTANT Real OCTAVE_SHIFT_X = 0.37;
CONSTANT Real OCTAVE_SHIFT_Y = 0.71;
CONSTANT Real OCTAVE_SHIFT_Z = 0.53;

// `aside`: of the camera's foot point, in the planet's frame.
Terrain terrain_at(Vec3 aside, Real footprint_km) {
  Terrain terrain;
  terrain.octaves = octaves_down_to(footprint_km);
  Uint seed = surface_seed() * 64u;
  Real frequency = FIRST_FREQUENCY;
  Real amplitude = 1.0;
  Real ridges = 0.0;
  Real ridge_amplitude = 1.0;
  Real ridge_sum = 0.0;
  Real before = 1.0;
  terrain.continent = 0.0;
  for (int octave = 0; octave < OCTAVES; ++octave) {
    Real shown = min(terrain.octaves - Real(octave), 1.0);
    if (shown <= 0.0) break;
    Vec4 cell = READ(surface_values, SURFACE_LATTICE + 2 * octave);
    Vec4 in_cell = READ(surface_values, SURFACE_LATTICE + 2 * octave + 1);
    Real noise = gradient_noise(Vec3(cell.x, cell.y, cell.z),
                                Vec3(in_cell.x, in_cell.y, in_cell.z) + aside * frequency,
                                seed + Uint(octave)) * shown;
    terrain.continent += amplitude * noise;
    if (octave >= FIRST_RIDGES) {
      // Ridges of faded octaves are flat at their mean.
      Real ridge = 1.0 - min(abs(noise) * 2.4, 1.0);
      ridge = mix(Real(0.32), ridge * ridge, shown);
      ridges += ridge_amplitude * (ridge - 0.32) * before;
      ridge_sum += ridge_amplitude;
      before = clamp(0.25 + 1.5 * ridge, 0.0, 1.0);
      ridge_amplitude *= terrain_gain();
    }
    amplitude *= terrain_gain();
    frequency *= 2.0;
  }
  terrain.land = terrain.continent - sea_level();
  terrain.grain = ridges;
  // Plains, and ranges of mountains here and there.
  Real ranges = smooth_step(-0.1, 0.3, gradient_noise((foot_direction() + aside) * Real(2.9) + Vec3(5.2, 1.3, 8.1), seed + 40u));
  Real inland = smooth_step(0.0, 0.3, terrain.land);
  Real ridged = clamp(0.34 + 0.6 * ridges, 0.0, 1.0);
  terrain.height = inland * clamp(0.03 + 0.1 * min(terrain.land, 0.5) +
                                  (0.06 + 0.94 * ranges) * ridged * ridged * 1.6, 0.0, 1.0);
  return terrain;
}
