// What there is at a place of the ground, whatever the ground is: places are directions from the planet's
// centre in the frame of the camera's foot point. SURFACE_KIND is a constant of the kernel, which so holds the code
// of one kind alone.

// Above the sphere of the ground, km.
Real height_of_ground_km(Vec3 place, Real footprint_km) {
  if (SURFACE_KIND == SURFACE_MAP) {
    return map_height(planet_direction(place), footprint_km) * surface_relief_km();
  }
  return terrain_at(planet_direction(aside_of_foot(place)), footprint_km).height * surface_relief_km();
}

// The same, and what it is made of.
Real look_at_ground(Vec3 place, Real footprint_km, OUT_ARRAY(Real, share, MATTERS)) {
  Vec3 n = planet_direction(place);
  if (SURFACE_KIND == SURFACE_MAP) {
    map_matter(n, footprint_km, share);
    return map_height(n, footprint_km) * surface_relief_km();
  }
  Terrain terrain = terrain_at(planet_direction(aside_of_foot(place)), footprint_km);
  matter_of(n, terrain, share);
  return terrain.height * surface_relief_km();
}
