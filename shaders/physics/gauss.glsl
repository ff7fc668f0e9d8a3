// Gauss-Legendre rules on [0, 1] [Abramowitz and Stegun 1964, table 25.4]. Loops over them are unrolled,
// so that nodes and weights become literals.

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
