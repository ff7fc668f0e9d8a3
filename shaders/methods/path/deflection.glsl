// Deflections drawn from phase functions: exactly from Henyey and Greenstein's and Rayleigh's, from close
// relatives of the others, whose weights stay near 1.

// 1 - cos of an angle drawn from Henyey and Greenstein's phase function, without cancellation in the
// peak: their formula for cos with u counted from the forward end.
Real henyey_greenstein_deflection(Real g, Real u) {
  Real a = abs(g);
  Real scale = 1.0 / (1.0 + a - 2.0 * a * u);
  Real root = (1.0 - a) * (1.0 + a) * scale;
  Real deflection = clamp((1.0 - a) * u * (root + 1.0 - a) * scale, 0.0, 2.0);
  return g < 0.0 ? 2.0 - deflection : deflection;
}

// The same for 3 / (16 pi) (1 + cos^2): the root of cos^3 + 3 cos = z.
Real rayleigh_deflection(Real u) {
  Real z = 8.0 * u - 4.0;
  Real root = pow(0.5 * (abs(z) + sqrt(z * z + 4.0)), 1.0 / 3.0);
  Real cosine = root - 1.0 / root;
  return clamp(1.0 - (z < 0.0 ? -cosine : cosine), 0.0, 2.0);
}

// Tabulated phases are drawn from cells in 1 - cos that all have the same share of the light.
int phase_cell(int c, Real deflection) {
  int low = 0;
  int high = PHASE_CELLS;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (phase_cell_edge(c, middle) <= deflection) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

Real proposed_deflection(int c, Real u) {
  MediumData m = medium(c);
  if (m.phase == PHASE_HENYEY_GREENSTEIN || m.phase == PHASE_CORNETTE_SHANKS) {
    return henyey_greenstein_deflection(m.g, u);
  }
  if (m.phase == PHASE_TABLE) {
    int cell = min(int(u * Real(PHASE_CELLS)), PHASE_CELLS - 1);
    Real from = phase_cell_edge(c, cell);
    return from + (phase_cell_edge(c, cell + 1) - from) * (u * Real(PHASE_CELLS) - Real(cell));
  }
  return rayleigh_deflection(u);
}

// Their density, 1/sr.
Real proposed_phase(int c, ScatteringAngle angle) {
  MediumData m = medium(c);
  if (m.phase == PHASE_HENYEY_GREENSTEIN || m.phase == PHASE_CORNETTE_SHANKS) {
    return henyey_greenstein_phase(m.g, angle);
  }
  if (m.phase == PHASE_TABLE) {
    int cell = phase_cell(c, angle.one_minus_cosine);
    Real width = phase_cell_edge(c, cell + 1) - phase_cell_edge(c, cell);
    return 1.0 / (2.0 * PI * Real(PHASE_CELLS) * width);
  }
  return 3.0 / (16.0 * PI) * (1.0 + angle.cosine * angle.cosine);
}

// One of the constituents by `share` (which sum to 1), and its deflection.
Real mixed_deflection(ARRAY(Real, share, MEDIA_SIZE), Real pick, Real u) {
  Real deflection = 2.0 * u;
  Real sum = 0.0;
  bool found = false;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    sum += share[c];
    if (!found && share[c] > 0.0) {  // the last one too where rounding has kept the sum below 1
      deflection = proposed_deflection(c, u);
      found = pick < sum;
    }
  }
  return deflection;
}

Real mixed_phase(ARRAY(Real, share, MEDIA_SIZE), ScatteringAngle angle) {
  Real density = 0.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    if (share[c] > 0.0) density += share[c] * proposed_phase(c, angle);
  }
  return density;
}
