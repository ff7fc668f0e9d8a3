// Gradient noise [Perlin 1985; 2002, the quintic] with the gradients of an integer hash: the same on every
// device and in double.

Uint lattice_hash(int x, int y, int z, Uint seed) {
  Uint h = (Uint(x) * 0x8da6b343u) ^ (Uint(y) * 0xd8163841u) ^ (Uint(z) * 0xcb1ab31fu) ^
           (seed * 0x9e3779b9u);
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return h ^ (h >> 15);
}

// Components are even between -1 and 1.
Real lattice_slope(int x, int y, int z, Uint seed, Vec3 offset) {
  Uint h = lattice_hash(x, y, z, seed);
  Vec3 gradient = Vec3(Real(h & 1023u), Real((h >> 10) & 1023u), Real((h >> 20) & 1023u)) *
                      Real(2.0 / 1023.0) - Vec3(1.0);
  return dot(gradient, offset);
}

// Between about -1 and 1, its mean 0, its standard deviation 0.27. At `aside` from the corner of a cell of the lattice,
// so that places far from its origin are known as well as those near it.
Real gradient_noise(Vec3 corner, Vec3 aside, Uint seed) {
  Vec3 further = floor(aside);
  Vec3 cell = corner + further;
  Vec3 f = aside - further;
  int x = int(cell.x);
  int y = int(cell.y);
  int z = int(cell.z);
  Vec3 u = f * f * f * (f * (f * Real(6.0) - Real(15.0)) + Real(10.0));
  Real low = mix(
      mix(lattice_slope(x, y, z, seed, f),
          lattice_slope(x + 1, y, z, seed, f - Vec3(1.0, 0.0, 0.0)), u.x),
      mix(lattice_slope(x, y + 1, z, seed, f - Vec3(0.0, 1.0, 0.0)),
          lattice_slope(x + 1, y + 1, z, seed, f - Vec3(1.0, 1.0, 0.0)), u.x), u.y);
  Real high = mix(
      mix(lattice_slope(x, y, z + 1, seed, f - Vec3(0.0, 0.0, 1.0)),
          lattice_slope(x + 1, y, z + 1, seed, f - Vec3(1.0, 0.0, 1.0)), u.x),
      mix(lattice_slope(x, y + 1, z + 1, seed, f - Vec3(0.0, 1.0, 1.0)),
          lattice_slope(x + 1, y + 1, z + 1, seed, f - Vec3(1.0, 1.0, 1.0)), u.x), u.y);
  return mix(low, high, u.z);
}

Real gradient_noise(Vec3 p, Uint seed) { return gradient_noise(Vec3(0.0), p, seed); }
