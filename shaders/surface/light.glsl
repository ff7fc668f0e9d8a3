// What the ground at a place makes of the light that falls on it: each matter is Lambertian, but for the sea,
// which mirrors (sea.glsl).

struct GroundPlace {
  Vec3 normal;
  Real sea;          // share of the sea, whose normal is the vertical
  Vec3 up;
};

// Of all matters but the sea, by their shares.
Vec4 dry_albedo(ARRAY(Real, share, MATTERS), int group) {
  Vec4 albedo = Vec4(0.0);
  UNROLL for (int m = 0; m < MATTERS; ++m) {
    if (m != SEA) albedo = albedo + share[m] * matter_albedo(m, group);
  }
  return albedo;
}

// As Lambertian ground that reflects as much of an even sky.
Vec4 even_albedo(ARRAY(Real, share, MATTERS), int group) {
  Real mirrored = mean_sea_reflectance();
  return dry_albedo(share, group) +
         share[SEA] * (mirrored + (1.0 - mirrored) * matter_albedo(SEA, group));
}

// Directions in the frame whose z axis is `up`; only angles between them matter.
Vec3 seen_upright(Vec3 up, Vec3 v) {
  Vec3 side = abs(up.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(1.0, 0.0, 0.0);
  Vec3 across = normalize(cross(side, up));
  return Vec3(dot(across, v), dot(cross(up, across), v), dot(up, v));
}

// Radiance towards the eye, 1/sr, for a unit of irradiance on a plane that faces the light.
Vec4 reflected_beam(GroundPlace place, ARRAY(Real, share, MATTERS), Vec3 to_light, Vec3 to_eye,
                    int group) {
  Vec4 radiance = dry_albedo(share, group) * (max(dot(place.normal, to_light), 0.0) / PI);
  Vec3 light = seen_upright(place.up, to_light);
  Vec3 eye = seen_upright(place.up, to_eye);
  if (share[SEA] <= 0.0 || light.z <= 0.0) return radiance;
  Vec4 sea = Vec4(sea_glint(light, eye)) +
             matter_albedo(SEA, group) * under_water(light.z, eye.z);
  return radiance + sea * (share[SEA] * light.z);
}

// How much brighter than an even sky of the same irradiance the sky is at a zenith cosine: as air of an optical
// depth that is lit evenly and scatters once is.
Vec4 brightness_of_sky(Vec4 depth, Real cosine) {
  Vec4 mean = Vec4(0.0);
  UNROLL for (int i = 0; i < 4; ++i) {
    Real mu = gauss4_node(i);
    mean = mean + gauss4_weight(i) * 2.0 * mu * (1.0 - exp(-depth / mu));
  }
  return (1.0 - exp(-depth / cosine)) / max(mean, Vec4(1e-9));
}

// Zenith cosine from which the sea mirrors the sky towards a zenith cosine: slopes that turn away from
// the eye lift it.
Real mirrored_cosine(Real cosine) { return sqrt(cosine * cosine + sea_slope_variance()); }

// Radiance towards the eye, 1/sr, under an even sky that gives a horizontal plane `sky` and even ground that
// sends `below`: a tilted plane sees its shares of both [Liu and Jordan 1963]. The sea mirrors what is `mirrored_sky`
// times as bright.
Vec4 reflected_sky(GroundPlace place, ARRAY(Real, share, MATTERS), Vec3 to_eye, Vec4 sky, Vec4 below,
                   Vec4 mirrored_sky, int group) {
  Real open = 0.5 + 0.5 * dot(place.normal, place.up);
  Vec4 radiance = dry_albedo(share, group) / PI * (open * sky + (1.0 - open) * below);
  Real mirrored = sea_reflectance(max(dot(place.up, to_eye), 0.0));
  return radiance + (share[SEA] / PI) * sky *
                        (mirrored * mirrored_sky + (1.0 - mirrored) * matter_albedo(SEA, group));
}
