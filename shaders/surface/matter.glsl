// What the ground is made of at a place: shares that add up to 1.

// Change of the continents' level over a footprint, which is what a coast is wide: octaves grow weaker in
// proportion to a power of their length.
Real coast_width(Real octaves) { return 0.5 * pow(terrain_gain(), octaves); }

void matter_of(Vec3 n, Terrain terrain, OUT_ARRAY(Real, share, MATTERS)) {
  Uint seed = surface_seed() * 64u;
  // The built-in asin may be wrong by 4e-4 (Mesa), which a coast of ice would show.
  Real latitude_deg = abs(atan(n.z, length(Vec2(n.x, n.y)))) * (180.0 / PI);
  Real width = coast_width(terrain.octaves);
  Real sea = 1.0 - smooth_step(-width, width, terrain.land);

  // Colder by one relief's height as by 75 degrees of latitude.
  Real weather = gradient_noise(n * Real(4.3) + Vec3(1.7, 9.2, 3.4), seed + 41u) +
                 0.5 * gradient_noise(n * Real(13.7) + Vec3(6.1, 2.8, 7.7), seed + 42u);
  Real cold_deg = latitude_deg + 12.0 * weather + 75.0 * terrain.height +
                  6.0 * terrain.grain * (1.0 - sea) -
                  ice_latitude_deg();
  if (ice_latitude_deg() >= 90.0) cold_deg = 75.0 * (terrain.height - 0.8) + 10.0 * terrain.grain;
  // Floes float farther poleward than snow lies.
  Real ice = smooth_step(-4.0, 4.0, cold_deg - 6.0 * sea);
  if (ice_latitude_deg() <= 0.0) ice = 1.0;

  // Deserts under the sinking air of the tropics' edges, woods at the equator and beyond them.
  Real belt = (latitude_deg - 23.0) / 11.0;
  Real wet = 0.55 + 0.9 * gradient_noise(n * Real(2.3) + Vec3(4.4, 0.6, 2.9), seed + 43u) +
             0.5 * gradient_noise(n * Real(8.9) + Vec3(3.3, 7.1, 0.2), seed + 44u) -
             0.5 * exp(-belt * belt) + 0.3 * terrain.grain;
  Real dry_edge = 1.9 - 3.4 * vegetation();
  Real plants = smooth_step(dry_edge - 0.25, dry_edge + 0.25, wet);
  Real rock = smooth_step(0.28, 0.6, terrain.height + 0.5 * terrain.grain);
  Real barren = smooth_step(-0.1, 0.35, terrain.grain);

  share[SEA] = sea * (1.0 - ice);
  share[ICE] = ice;
  Real land = (1.0 - sea) * (1.0 - ice);
  share[ROCK] = land * max(rock, 0.4 * barren * (1.0 - plants));
  share[PLANTS] = (land - share[ROCK]) * plants;
  share[SAND] = land - share[ROCK] - share[PLANTS];
}
