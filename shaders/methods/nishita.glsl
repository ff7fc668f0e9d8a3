// Single scattering by a nested march [Nishita et al. 1993, section 4]: the midpoint rule, uniform in
// distance, on the view ray and from each of its samples towards the sun. Converges with the square
// of both steps where nothing jumps; the planet's shadow on the ray is a jump.

// Columns of every constituent from a point to the light; false in the planet's shadow.
bool columns_to_sun(Real h, Real mu, int samples,
                    OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  if (meets_ground(h, mu)) return false;
  Real step_km = distance_to_top(h, mu) / Real(samples);
  Real density[MEDIA_SIZE];
  for (int i = 0; i < samples; ++i) {
    densities(altitude_after(h, mu, (Real(i) + 0.5) * step_km), density);
    for (int c = 0; c < MEDIA; ++c) column[c] += density[c];
  }
  for (int c = 0; c < MEDIA; ++c) column[c] *= step_km;
  return true;
}

// The samples [first, end) of a view ray. `view_column` is carried from one call to the next and
// summed once along the ray; radiance is added to `inscatter`.
void march_view(Path path, int first, int end, int view_samples, int light_samples,
                INOUT_ARRAY(Real, view_column, MEDIA_SIZE),
                INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Real step_km = path.length_km / Real(view_samples);
  int suns = MANY_SUNS ? scene.disc_points : 1;
  Real density[MEDIA_SIZE];
  Real column[MEDIA_SIZE];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  bool sun_varies = NEAR_SUN || MANY_SUNS;
  if (!sun_varies) {
    scattering_towards(
        scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction),
        scattering_phase);
  }
  for (int i = first; i < end; ++i) {
    Real t = (Real(i) + 0.5) * step_km;
    Real h = altitude_after(path.altitude_km, path.mu, t);
    Vec3 position = path.start + path.direction * t;
    densities(h, density);
    for (int k = 0; k < suns; ++k) {
      SunRay sun = sun_ray(position, MANY_SUNS ? sun_offset(k) : Vec3(0.0));
      Real mu_sun = dot(position, sun.direction) / length(position);
      if (!columns_to_sun(h, mu_sun, light_samples, column)) continue;
      if (sun_varies) {
        scattering_towards(scattering_angle(sun.direction, path.direction), scattering_phase);
      }
      for (int c = 0; c < MEDIA; ++c) {
        column[c] += view_column[c] + 0.5 * step_km * density[c];
      }
      for (int group = 0; group < GROUPS; ++group) {
        Vec4 source = Vec4(0.0);
        for (int c = 0; c < MEDIA; ++c) {
          source = source + scattering_phase[c * GROUPS_SIZE + group] * density[c];
        }
        Vec4 light = transmittance_of(column, group) * (sun.irradiance * step_km);
        if (MANY_SUNS) light = light * sun_weight(k, group);
        inscatter[group] = inscatter[group] + source * light;
      }
    }
    for (int c = 0; c < MEDIA; ++c) view_column[c] += step_km * density[c];
  }
}

// Radiance of the sunlit ground at the end of a path that meets it, before the air in front of it.
void sunlit_ground(Path path, int light_samples, OUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  for (int group = 0; group < GROUPS; ++group) ground[group] = Vec4(0.0);
  if (!path.meets_ground) return;
  Vec3 position = path.start + path.direction * path.length_km;
  int suns = MANY_SUNS ? scene.disc_points : 1;
  Real column[MEDIA_SIZE];
  for (int k = 0; k < suns; ++k) {
    SunRay sun = sun_ray(position, MANY_SUNS ? sun_offset(k) : Vec3(0.0));
    Real mu_sun = dot(position, sun.direction) / length(position);
    if (mu_sun <= 0.0 || !columns_to_sun(0.0, mu_sun, light_samples, column)) continue;
    for (int group = 0; group < GROUPS; ++group) {
      Vec4 light = transmittance_of(column, group) * (sun.irradiance * mu_sun);
      if (MANY_SUNS) light = light * sun_weight(k, group);
      ground[group] = ground[group] + lambertian(group) * light;
    }
  }
}
