// Order two at a point, for scattering that is isotropic from there on, and how much of isotropic light
// comes back to it by one more scattering: what the geometric series of all further orders stands on
// [Hillaire 2020, section 5.5].

// Points spread evenly over the sphere: a Fibonacci lattice, mu its zenith cosine.
Real lattice_cosine(int i, int count) { return 1.0 - (2.0 * Real(i) + 1.0) / Real(count); }
// Over the hemisphere above, in proportion to mu.
Real lattice_cosine_above(int i, int count) { return sqrt((Real(i) + 0.5) / Real(count)); }
Real lattice_azimuth(int i) { return Real(i) * 2.399963229728653; }  // PI (3 - sqrt(5))

// Adds what comes from one direction to a point: radiance scattered once and sunlight reflected by the
// ground; the share of the way along it that is not scattering (absorbed, gone to space or the
// ground); the share of the ground that is seen.
void add_second_order(SunlitRay ray, int samples, Real scale_height_km,
                      INOUT_ARRAY(Vec4, radiance, GROUPS_SIZE),
                      INOUT_ARRAY(Vec4, lost, GROUPS_SIZE),
                      INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  Real column[MEDIA_SIZE];
  Vec4 density[MEDIA_SIZE];
  Vec4 column_to[MEDIA_SIZE];
  Vec4 light[GROUPS_SIZE];
  Vec4 scattered_once[GROUPS_SIZE];
  Vec4 scattered_share[GROUPS_SIZE];
  Vec4 absorbed_share[GROUPS_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    scattered_once[group] = Vec4(0.0);
    scattered_share[group] = Vec4(0.0);
    absorbed_share[group] = Vec4(0.0);
  }
  Panels panels = panels_along(ray, shadow_over(ray), samples, scale_height_km);
  int count = number_of(panels);
  for (int p = 0; p < count; ++p) {
    Panel panel = panel_of(panels, p);
    pass_panel(ray, panel, column, density, column_to);
    for (int i = 0; i < 4; ++i) {
      Node node = node_of(ray, panel, i);
      transmittance_to_sun(node.altitude_km, node.mu_sun, light);
      UNROLL for (int group = 0; group < GROUPS; ++group) {
        Vec4 seen = seen_width(node, column_to, i, group);
        Vec4 scattered = Vec4(0.0);
        Vec4 absorbed = Vec4(0.0);
        UNROLL for (int c = 0; c < MEDIA; ++c) {
          scattered = scattered + scattering(c, group) * density[c][i];
          absorbed = absorbed + (extinction(c, group) - scattering(c, group)) * density[c][i];
        }
        scattered_share[group] = scattered_share[group] + scattered * seen;
        absorbed_share[group] = absorbed_share[group] + absorbed * seen;
        if (panel.lit) {
          scattered_once[group] = scattered_once[group] + scattered * seen * light[group] / (4.0 * PI);
        }
      }
    }
  }
  Vec4 transmittance[GROUPS_SIZE];
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    transmittance[group] = transmittance_of(column, group);
    Vec4 kept = kept_of_found(scattered_share[group] + absorbed_share[group], transmittance[group]);
    radiance[group] = radiance[group] + kept * scattered_once[group];
    lost[group] = lost[group] + kept * absorbed_share[group] + transmittance[group];
  }
  if (!ray.meets_ground) return;
  Real mu_sun = sun_cosine_after(ray, 0.0, ray.length_km);
  transmittance_to_sun(0.0, mu_sun, light);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    ground[group] = ground[group] + transmittance[group];
    radiance[group] = radiance[group] + transmittance[group] * lambertian(group) *
                                            light[group] * max(mu_sun, 0.0);
  }
}

// No more is anywhere in air that absorbs nothing, per unit irradiance: it is sqrt(3) H(1) / (4 PI) = 0.40
// deep below an overhead sun [Chandrasekhar 1960, Radiative Transfer, section 22], and where nearly nothing
// is lost the series makes anything of what quadrature leaves.
CONSTANT Real MOST_MEAN_RADIANCE = 0.5;

// 1 + r + r^2 + ..., so many terms or (below 0) all; r = 1 - lost, which is less than 1 because no ray
// ends without having lost something.
Vec4 series(Vec4 lost, int terms) {
  Vec4 some = max(lost, Vec4(1e-37));
  if (terms < 0) return 1.0 / some;
  return (1.0 - pow(max(1.0 - some, Vec4(1e-30)), Vec4(Real(terms)))) / some;
}
