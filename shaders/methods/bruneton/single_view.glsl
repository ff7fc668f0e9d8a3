// Reads the tables of the first order for a path. Included after view_table.glsl and single_table.glsl.

// Linear in all four coordinates: one of the 16 corners of the cell of a position.
struct Corner {
  int texel;
  Real weight;
};

Real share_of(Between at, int upper) { return upper == 1 ? at.share : 1.0 - at.share; }

Corner corner_of(ViewPosition at, int i) {
  int altitude = i & 1;
  int s = (i >> 1) & 1;
  int zenith = (i >> 2) & 1;
  int azimuth = i >> 3;
  int place = (at.altitude.node + altitude) * grid.suns + at.sun.node + s;
  Corner corner;
  corner.texel = (place * grid.zeniths + at.zenith.node + zenith) * grid.azimuths + at.azimuth.node + azimuth;
  corner.weight = share_of(at.altitude, altitude) * share_of(at.sun, s) * share_of(at.zenith, zenith) *
                  share_of(at.azimuth, azimuth);
  return corner;
}

Vec4 single(ViewPosition at, int table) {
  Vec4 sum = Vec4(0.0);
  ROLLED for (int i = 0; i < 16; ++i) {
    Corner corner = corner_of(at, i);
    sum = sum + corner.weight * READ(singles, table * texels() + corner.texel);
  }
  return sum;
}

Real first_wavelength(ViewPosition at, int c) {
  Real sum = 0.0;
  ROLLED for (int i = 0; i < 16; ++i) {
    Corner corner = corner_of(at, i);
    sum += corner.weight * READ_REAL(first_wavelengths, c * texels() + corner.texel);
  }
  return sum;
}

Vec4 molecular_coefficient(int group) {
  Vec4 sum = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    if (molecular(c)) sum = sum + scattering(c, group);
  }
  return sum;
}

// Particles in the colours of the molecules' table: [Bruneton and Neyret 2008, section 4], C_M = C_R
// times the ratio of the two in the first wavelength, each divided by its coefficient.
void add_reconstructed(ViewPosition at, ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE),
                       INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Real first_column =
      single(at, 0).x / max(molecular_coefficient(0).x, 1e-30);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 coefficient = max(molecular_coefficient(g), Vec4(1e-30));
    Vec4 column = single(at, g) / coefficient;
    Vec4 molecules = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      if (molecular(c)) {
        molecules = molecules + scattering_phase[c * GROUPS + g];
      } else {
        inscatter[g] = inscatter[g] + scattering_phase[c * GROUPS + g] * column *
                                          (first_wavelength(at, c) /
                                           max(first_column, 1e-30));
      }
    }
    inscatter[g] = inscatter[g] + molecules * column;
  }
}

void add_single(Path path, INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  ViewPosition at = view_position(path);
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  scattering_towards(scattering_angle(towards_sun(), path.direction), scattering_phase);
  if (!SEPARATE) {
    add_reconstructed(at, scattering_phase, inscatter);
    return;
  }
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      inscatter[g] = inscatter[g] +
                     scattering_phase[c * GROUPS + g] * single(at, c * GROUPS + g);
    }
  }
}
