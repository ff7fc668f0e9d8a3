// Columns (km of density 1) of every constituent, and what they leave of the light.

// Optical depth: the sum of extinction times column.
Vec4 depth_of(ARRAY(Real, column, MEDIA_SIZE), int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + extinction(c, group) * column[c];
  return depth;
}

Vec4 transmittance_of(ARRAY(Real, column, MEDIA_SIZE), int group) { return exp(-depth_of(column, group)); }

// Mean of exp(-x) for x from 0 to an optical depth.
Real mean_transmittance(Real depth) {
  return depth > 0.03 ? (1.0 - exp(-depth)) / depth
                      : 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth / 24.0));
}

Vec4 mean_transmittances(Vec4 depth) {
  return Vec4(mean_transmittance(depth.x), mean_transmittance(depth.y),
              mean_transmittance(depth.z), mean_transmittance(depth.w));
}

// Radiance of the Lambertian ground under an irradiance of 1 on a horizontal plane, 1/sr.
Vec4 lambertian(int group) { return ground_albedo(group) / PI; }

// What methods leave of the light that falls on the ground: its radiance as it is seen through the air before it.
// Where the ground differs from place to place it is the irradiance of a horizontal plane, the sun's own apart;
// surface/surface_light.comp makes radiance of it.
Vec4 left_by_ground(Vec4 irradiance, int group) {
  return scene.surface != 0 ? irradiance : lambertian(group) * irradiance;
}
Vec4 ground_seen(Vec4 ground, Vec4 transmittance) {
  return scene.surface != 0 ? ground : ground * transmittance;
}

// Radiance from one sample of the view ray under one sun, for columns to the camera and to the sun
// together.
void add_scattered(ARRAY(Real, column, MEDIA_SIZE), ARRAY(Real, density, MEDIA_SIZE),
                   ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE), Real weight, int sun,
                   INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 source = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      source = source + scattering_phase[c * GROUPS_SIZE + group] * density[c];
    }
    Vec4 light = transmittance_of(column, group) * weight;
    if (MANY_SUNS) light = light * sun_weight(sun, group);
    inscatter[group] = inscatter[group] + source * light;
  }
}

// Extinction coefficient at an altitude, 1/km, of the wavelength where it is largest, of those that columns of
// air before it leave more than exp(-unseen) of.
Real largest_extinction_behind(ARRAY(Real, column, MEDIA_SIZE), Real unseen, Real h) {
  Real density[MEDIA_SIZE];
  densities(h, density);
  Real largest = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 sum = Vec4(0.0);
    Vec4 depth = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      sum = sum + extinction(c, group) * density[c];
      depth = depth + extinction(c, group) * column[c];
    }
    sum = sum * step(depth, Vec4(unseen));
    largest = max(max(largest, max(sum.x, sum.y)), max(sum.z, sum.w));
  }
  return largest;
}

// The same of all wavelengths.
Real largest_extinction(Real h) {
  Real none[MEDIA_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) none[c] = 0.0;
  return largest_extinction_behind(none, 1.0, h);
}
