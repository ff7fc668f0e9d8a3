// Reads the tables of the first order for a path. Included after view_table.glsl and single_table.glsl.

// Linear in all four coordinates: the nearer corners of the cell of a position, and their weights.
struct Corners {
  int texel[16];
  Real weight[16];
};

Corners corners_of(ViewPosition at) {
  Corners corners;
  UNROLL for (int i = 0; i < 16; ++i) {
    int altitude = i & 1;
    int s = (i >> 1) & 1;
    int zenith = (i >> 2) & 1;
    int azimuth = i >> 3;
    int place = (at.altitude.node + altitude) * grid.suns + at.sun.node + s;
    corners.texel[i] = (place * grid.zeniths + at.zenith.node + zenith) * grid.azimuths +
                       at.azimuth.node + azimuth;
    corners.weight[i] = (altitude == 1 ? at.altitude.share : 1.0 - at.altitude.share) *
                        (s == 1 ? at.sun.share : 1.0 - at.sun.share) *
                        (zenith == 1 ? at.zenith.share : 1.0 - at.zenith.share) *
                        (azimuth == 1 ? at.azimuth.share : 1.0 - at.azimuth.share);
  }
  return corners;
}

Vec4 single(Corners corners, int table) {
  Vec4 sum = Vec4(0.0);
  UNROLL for (int i = 0; i < 16; ++i) {
    sum = sum + corners.weight[i] * singles[table * texels() + corners.texel[i]];
  }
  return sum;
}

Real first_wavelength(Corners corners, int c) {
  Real sum = 0.0;
  UNROLL for (int i = 0; i < 16; ++i) {
    sum += corners.weight[i] * first_wavelengths[c * texels() + corners.texel[i]];
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
void add_reconstructed(Corners corners, ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE),
                       INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Real first_column =
      single(corners, 0).x / max(molecular_coefficient(0).x, 1e-30);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 coefficient = max(molecular_coefficient(g), Vec4(1e-30));
    Vec4 column = single(corners, g) / coefficient;
    Vec4 molecules = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      if (molecular(c)) {
        molecules = molecules + scattering_phase[c * GROUPS + g];
      } else {
        inscatter[g] = inscatter[g] + scattering_phase[c * GROUPS + g] * column *
                                          (first_wavelength(corners, c) /
                                           max(first_column, 1e-30));
      }
    }
    inscatter[g] = inscatter[g] + molecules * column;
  }
}

void add_single(Path path, INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Corners corners = corners_of(view_position(path));
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  scattering_towards(scattering_angle(towards_sun(), path.direction), scattering_phase);
  if (!SEPARATE) {
    add_reconstructed(corners, scattering_phase, inscatter);
    return;
  }
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      inscatter[g] = inscatter[g] +
                     scattering_phase[c * GROUPS + g] * single(corners, c * GROUPS + g);
    }
  }
}
