// Light that the sea reflects: from facets whose slopes are Gaussian [Cox and Munk 1954], with Fresnel's
// reflectance of each and Smith's masking, which keeps the energy.

CONSTANT Real WATER_INDEX = 1.34;

// Unpolarised [Born and Wolf 1999, section 1.5.2].
Real fresnel_of_water(Real cosine) {
  Real sine = sqrt(max(1.0 - cosine * cosine, 0.0)) / WATER_INDEX;
  Real inside = sqrt(max(1.0 - sine * sine, 0.0));
  Real s = (cosine - WATER_INDEX * inside) / (cosine + WATER_INDEX * inside);
  Real p = (WATER_INDEX * cosine - inside) / (WATER_INDEX * cosine + inside);
  return 0.5 * (s * s + p * p);
}

// [Smith 1967], as Walter et al. [2007, after eq. 24] approximate it.
Real facets_hidden(Real cosine) {
  Real sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
  Real a = cosine / (sine * sqrt(sea_slope_variance()));
  return a < 1.6 ? (1.0 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a) : 0.0;
}

// BRDF of the surface, 1/sr, between two directions away from it; z is up.
Real sea_glint(Vec3 to_light, Vec3 to_eye) {
  if (to_light.z <= 0.0 || to_eye.z <= 0.0) return 0.0;
  Vec3 middle = normalize(to_light + to_eye);
  Real square = middle.z * middle.z;
  Real slopes = (1.0 - square) / (square * sea_slope_variance());
  Real facets = exp(-slopes) / (PI * sea_slope_variance());
  Real seen = 1.0 / (1.0 + facets_hidden(to_light.z) + facets_hidden(to_eye.z));
  return fresnel_of_water(clamp(dot(middle, to_eye), 0.0, 1.0)) * facets * seen /
         (4.0 * to_light.z * to_eye.z * square * square);
}

// What it reflects of an even sky towards a zenith cosine, or into all directions of a beam that comes from
// there: the integral of sea_glint, at cosines (i / (SEA_NODES - 1))^2.
Real sea_reflectance(Real cosine) {
  Real node = sqrt(clamp(cosine, 0.0, 1.0)) * Real(SEA_NODES - 1);
  int low = min(int(node), SEA_NODES - 2);
  int next = low + 1;
  return mix(READ(surface_values, SURFACE_SEA + low / 4)[low % 4],
             READ(surface_values, SURFACE_SEA + next / 4)[next % 4], node - Real(low));
}

// BRDF of the water below, whose albedo is 1: what the surface let in and lets out again. Together they
// reflect no more than there is [Shirley et al. 1997, A practitioners' assessment of light reflection models].
Real under_water(Real cosine, Real other) {
  return (1.0 - sea_reflectance(max(cosine, 0.0))) * (1.0 - sea_reflectance(max(other, 0.0))) /
         (PI * (1.0 - mean_sea_reflectance()));
}
