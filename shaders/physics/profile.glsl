// Relative densities of all constituents at an altitude. They are ordered by the type of their profile
// and the numbers of each type are constants of the pipeline, so a scene runs no code for types
// that it does not have.
//
//   exponential  exp(-h a)              a = 1 / scale height
//   tent         max(0, 1 - |h - a| b)  a the centre, b = 1 / half width
//   quadratic    (1 - h a)^2            a = 1 / thickness
//   uniform      1
//   table        nodes of (altitude, density, linear slope, logarithmic slope): with x the height
//                above the node (density + linear x) exp(logarithmic x), one slope being 0

Real tabulated_density(Real h, int first, int count) {
  int low = first;
  int high = first + count;  // the node wanted is in [low, high)
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (profile_nodes[middle].x <= h) {
      low = middle;
    } else {
      high = middle;
    }
  }
  Vec4 node = profile_nodes[low];
  Real x = h - node.x;
  return (node.y + node.z * x) * exp(node.w * x);
}

void densities(Real h, OUT_ARRAY(Real, density, MEDIA_SIZE)) {
  int c = 0;
  for (int i = 0; i < EXPONENTIALS; ++i) {
    density[c] = exp(-h * medium(c).a);
    ++c;
  }
  for (int i = 0; i < TENTS; ++i) {
    density[c] = max(0.0, 1.0 - abs(h - medium(c).a) * medium(c).b);
    ++c;
  }
  for (int i = 0; i < QUADRATICS; ++i) {
    Real x = 1.0 - h * medium(c).a;
    density[c] = x * x;
    ++c;
  }
  for (int i = 0; i < UNIFORMS; ++i) {
    density[c] = 1.0;
    ++c;
  }
  for (int i = 0; i < TABLES; ++i) {
    density[c] = tabulated_density(h, medium(c).profile_node, medium(c).profile_nodes);
    ++c;
  }
}
