// Parts of rays that end at something: what was scattered more than once on them, by elevation, azimuth and stop,
// as a ratio to what they scatter and let through,
//
//   scattering depth x mean transmittance,
//
// which carries nearly all that varies along a ray. Include moments_view.glsl before this.
#include "tables/stops.glsl"

const int PART_STOPS = 16;

// What a part of a ray with these columns scatters and lets through.
Vec4 part_scattered(ARRAY(Real, column, MEDIA_SIZE), int g) {
  Vec4 scattered = Vec4(0.0);
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    scattered = scattered + READ(spectra, (3 + 3 * c) * GROUPS + g) * column[c];
    depth = depth + READ(spectra, (2 + 3 * c) * GROUPS + g) * (share_of_extinction(c) * column[c]);
  }
  return scattered * mean_transmittances(depth);
}
