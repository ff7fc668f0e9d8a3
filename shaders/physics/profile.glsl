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
    if (READ(profile_nodes, middle).x <= h) {
      low = middle;
    } else {
      high = middle;
    }
  }
  Vec4 node = READ(profile_nodes, low);
  Real x = h - node.x;
  return (node.y + node.z * x) * exp(node.w * x);
}

Real relative_density(Real h, int c) {
  MediumData m = medium(c);
  if (c < EXPONENTIALS) return exp(-h * m.a);
  if (c < EXPONENTIALS + TENTS) return max(0.0, 1.0 - abs(h - m.a) * m.b);
  if (c < EXPONENTIALS + TENTS + QUADRATICS) return (1.0 - h * m.a) * (1.0 - h * m.a);
  if (c < MEDIA - TABLES) return 1.0;
  return tabulated_density(h, m.profile_node, m.profile_nodes);
}

// Of all constituents; unrolled, so that the comparisons above are gone.
void densities(Real h, OUT_ARRAY(Real, density, MEDIA_SIZE)) {
  UNROLL for (int c = 0; c < MEDIA; ++c) density[c] = relative_density(h, c);
}
