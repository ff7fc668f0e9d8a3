// Phase functions, 1/sr, integrating to 1 over the sphere.

// Cosine of the scattering angle between two unit vectors, with 1 - cos and 1 + cos kept apart:
// next to a forward or backward peak they carry the digits that the cosine has lost.
struct ScatteringAngle {
  Real cosine;
  Real one_minus_cosine;
  Real one_plus_cosine;
};

ScatteringAngle scattering_angle(Vec3 to_sun, Vec3 view) {
  ScatteringAngle angle;
  Vec3 difference = to_sun - view;
  Vec3 sum = to_sun + view;
  angle.cosine = dot(to_sun, view);
  angle.one_minus_cosine = 0.5 * dot(difference, difference);
  angle.one_plus_cosine = 0.5 * dot(sum, sum);
  return angle;
}

// In radians. The built-in atan may be wrong by 2e-5 (Mesa); one Newton step on the sine of
// the difference brings it to the precision of sin and cos.
Real angle_of(ScatteringAngle angle) {
  Real sine = sqrt(angle.one_minus_cosine * angle.one_plus_cosine);
  Real theta = atan(sine, angle.cosine);
  return max(theta + (sine * cos(theta) - angle.cosine * sin(theta)), 0.0);
}

// Rayleigh scattering with depolarisation [Chandrasekhar 1960; Bucholtz 1995, eq. 12], gamma by
// wavelength; 0 gives 3 / (16 pi) (1 + cos^2).
Vec4 rayleigh_phase(Vec4 gamma, Real cosine) {
  return 3.0 / (16.0 * PI) * (1.0 + 3.0 * gamma + (1.0 - gamma) * (cosine * cosine)) /
         (1.0 + 2.0 * gamma);
}

// 1 + g^2 - 2 g cos, without cancellation in the peak.
Real peak_denominator(Real g, ScatteringAngle angle) {
  return g > 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * angle.one_minus_cosine
                 : (1.0 + g) * (1.0 + g) - 2.0 * g * angle.one_plus_cosine;
}

// [Henyey and Greenstein 1941, eq. 2]
Real henyey_greenstein_phase(Real g, ScatteringAngle angle) {
  Real d = peak_denominator(g, angle);
  return (1.0 - g) * (1.0 + g) / (4.0 * PI * d * sqrt(d));
}

// [Cornette and Shanks 1992, eq. 8]
Real cornette_shanks_phase(Real g, ScatteringAngle angle) {
  Real d = peak_denominator(g, angle);
  return 3.0 / (8.0 * PI) * (1.0 - g) * (1.0 + g) * (1.0 + angle.cosine * angle.cosine) /
         ((2.0 + g * g) * d * sqrt(d));
}

// Linear in the logarithm, linear next to a zero.
Real log_linear(Real low, Real high, Real x) {
  return low > 0.0 && high > 0.0 ? low * exp(x * log(high / low)) : low + x * (high - low);
}

// Nodes of a tabulated phase: phase_angles[node] in radians and, group by group of wavelengths,
// phase_values[node * GROUPS + group]. `node` of the result is the last one at or below the angle.
struct PhasePosition {
  int node;
  Real fraction;
};

PhasePosition phase_position(MediumData m, ScatteringAngle angle) {
  PhasePosition position;
  Real theta = angle_of(angle);
  int low = m.phase_node;
  int high = m.phase_node + m.phase_nodes - 1;  // the node wanted is in [low, high)
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (READ_REAL(phase_angles, middle) <= theta) {
      low = middle;
    } else {
      high = middle;
    }
  }
  position.node = low;
  Real before = READ_REAL(phase_angles, low);
  Real after = READ_REAL(phase_angles, low + 1);
  position.fraction = clamp((theta - before) / (after - before), 0.0, 1.0);
  return position;
}

Vec4 tabulated_phase(PhasePosition position, int group) {
  Vec4 low = READ(phase_values, position.node * GROUPS + group);
  Vec4 high = READ(phase_values, (position.node + 1) * GROUPS + group);
  Real x = position.fraction;
  return Vec4(log_linear(low.x, high.x, x), log_linear(low.y, high.y, x),
              log_linear(low.z, high.z, x), log_linear(low.w, high.w, x));
}

// Scattering coefficient times phase function of every constituent, 1/(km sr) where its profile is 1.
void scattering_towards(ScatteringAngle angle,
                        OUT_ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE)) {
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    MediumData m = medium(c);
    PhasePosition position;
    Real same = 0.0;
    if (m.phase == PHASE_HENYEY_GREENSTEIN) same = henyey_greenstein_phase(m.g, angle);
    if (m.phase == PHASE_CORNETTE_SHANKS) same = cornette_shanks_phase(m.g, angle);
    if (PHASE_TABLES && m.phase == PHASE_TABLE) position = phase_position(m, angle);
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      Vec4 phase = Vec4(same);
      if (m.phase == PHASE_RAYLEIGH) {
        phase = rayleigh_phase(depolarisation(c, group), angle.cosine);
      }
      if (PHASE_TABLES && m.phase == PHASE_TABLE) phase = tabulated_phase(position, group);
      scattering_phase[c * GROUPS_SIZE + group] = scattering(c, group) * phase;
    }
  }
}
