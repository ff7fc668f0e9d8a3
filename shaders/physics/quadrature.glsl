// Gauss-Legendre rules on [0, 1] [Abramowitz and Stegun 1964, table 25.4]. Loops over those of a fixed
// number of nodes are unrolled, so that nodes and weights become literals.

// By which nodes gather about a place: even in it they are dense there, and thin out as a geometric series. Odd to the
// last digit.
Real inverse_sinh(Real x) {
  Real magnitude = log(abs(x) + sqrt(x * x + 1.0));
  return x < 0.0 ? -magnitude : magnitude;
}

Real gauss2_node(int i) { return i == 0 ? 0.2113248654051871 : 0.7886751345948129; }

Real gauss3_node(int i) {
  if (i == 0) return 0.1127016653792583;
  if (i == 1) return 0.5;
  return 0.8872983346207417;
}

Real gauss3_weight(int i) { return i == 1 ? 4.0 / 9.0 : 5.0 / 18.0; }

Real gauss4_node(int i) {
  if (i == 0) return 0.0694318442029737;
  if (i == 1) return 0.3300094782075719;
  if (i == 2) return 0.6699905217924281;
  return 0.9305681557970262;
}

Real gauss4_weight(int i) {
  if (i == 0 || i == 3) return 0.1739274225687268;
  return 0.3260725774312732;
}

Real gauss8_node(int i) {
  if (i == 0) return 0.0198550717512319;
  if (i == 1) return 0.1016667612931866;
  if (i == 2) return 0.2372337950418355;
  if (i == 3) return 0.4082826787521751;
  if (i == 4) return 0.5917173212478248;
  if (i == 5) return 0.7627662049581645;
  if (i == 6) return 0.8983332387068134;
  return 0.9801449282487681;
}

Real gauss8_weight(int i) {
  if (i == 0 || i == 7) return 0.0506142681451885;
  if (i == 1 || i == 6) return 0.1111905172266872;
  if (i == 2 || i == 5) return 0.1568533229389434;
  return 0.1813418916891808;
}

// Rules of 1 to MOST_GAUSS_NODES nodes lie one after another in a buffer, (node, weight) each, and behind
// them the altitudes of the scene's kinks.
CONSTANT int MOST_GAUSS_NODES = 32;
CONSTANT int GAUSS_RULES_SIZE = MOST_GAUSS_NODES * (MOST_GAUSS_NODES + 1) / 2;

Vec2 gauss_node(int nodes, int i) {
  Vec4 node = READ(quadrature, nodes * (nodes - 1) / 2 + i);
  return Vec2(node.x, node.y);
}

// An altitude at which the density of a constituent jumps or bends, km.
Real kink_km(int i) { return READ(quadrature, GAUSS_RULES_SIZE + i).x; }
