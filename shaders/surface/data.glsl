// What the surface of the scene is, in the buffer `surface_values`: two Vec4 of numbers, two for images, three for the
// turn to the planet's frame, four for the sea, two for each octave of a procedural surface, then the spectra of what it is
// made of, group by group of wavelengths.

CONSTANT int SURFACE_UNIFORM = 0;
CONSTANT int SURFACE_PROCEDURAL = 1;
CONSTANT int SURFACE_MAP = 2;

// What the ground is made of: a share each, whose spectra mix.
CONSTANT int MATTERS = 5;
CONSTANT int SEA = 0;  // of procedural surfaces
CONSTANT int PLANTS = 1;
CONSTANT int SAND = 2;
CONSTANT int ROCK = 3;
CONSTANT int ICE = 4;
CONSTANT int RED = 1;  // of maps
CONSTANT int GREEN = 2;
CONSTANT int BLUE = 3;

CONSTANT int SURFACE_COLOURS = 2;  // images of a map: columns, rows, levels, first texel
CONSTANT int SURFACE_HEIGHTS = 3;
CONSTANT int SURFACE_SEA = 7;     // its reflectance at SEA_NODES cosines (sea.glsl)
CONSTANT int SEA_NODES = 16;
CONSTANT int OCTAVES = 18;
// Where the camera's foot point lies in each octave's lattice (terrain.glsl): its cell, and the place in it.
CONSTANT int SURFACE_LATTICE = SURFACE_SEA + SEA_NODES / 4;
CONSTANT int SURFACE_SPECTRA = SURFACE_LATTICE + 2 * OCTAVES;

Real surface_relief_km() { return READ(surface_values, 0).x; }  // no height is above it
Real sea_level() { return READ(surface_values, 0).y; }          // of continents, as terrain.glsl has them
Real terrain_gain() { return READ(surface_values, 0).z; }       // of an octave over the one before
Real sea_slope_variance() { return READ(surface_values, 0).w; }
Real ice_latitude_deg() { return READ(surface_values, 1).x; }
Real vegetation() { return READ(surface_values, 1).y; }
Uint surface_seed() { return Uint(READ(surface_values, 1).z); }
Real mean_sea_reflectance() { return READ(surface_values, 1).w; }  // under an even sky

Vec4 matter_albedo(int matter, int group) {
  return READ(surface_values, SURFACE_SPECTRA + matter * GROUPS + group);
}

// From the camera's foot point to a place, both directions from the planet's centre in the foot point's frame. As
// accurate as the horizontal coordinates of the place, which near the foot point are small: on a real planet the
// difference of two unit vectors of floats is half a metre off.
Vec3 aside_of_foot(Vec3 place) {
  Real drop = place.z > 0.0 ? -(place.x * place.x + place.y * place.y) / (1.0 + place.z) : place.z - 1.0;
  return Vec3(place.x, place.y, drop);
}

// The foot point, in the planet's frame.
Vec3 foot_direction() {
  Vec4 up = READ(surface_values, 6);
  return Vec3(up.x, up.y, up.z);
}

// A direction from the planet's centre, in the frame of the camera's foot point, in that of the planet: z to
// the north pole, x to latitude and longitude 0.
Vec3 planet_direction(Vec3 local) {
  Vec4 east = READ(surface_values, 4);
  Vec4 north = READ(surface_values, 5);
  Vec4 up = READ(surface_values, 6);
  return Vec3(east.x, east.y, east.z) * local.x + Vec3(north.x, north.y, north.z) * local.y +
         Vec3(up.x, up.y, up.z) * local.z;
}
