// Columns (km of density 1) of every constituent, and what they leave of the light.

// exp(-sum of extinction times column).
Vec4 transmittance_of(ARRAY(Real, column, MEDIA_SIZE), int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + extinction(c, group) * column[c];
  return exp(-depth);
}

// Radiance of the Lambertian ground under an irradiance of 1 on a horizontal plane, 1/sr.
Vec4 lambertian(int group) { return ground_albedo(group) / PI; }
