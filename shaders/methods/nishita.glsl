// Single scattering by a nested march [Nishita et al. 1993, section 4]: the midpoint rule, uniform in
// distance, on the view ray and from each of its samples towards the sun. Converges with the square
// of both steps where nothing jumps; the planet's shadow on the ray is a jump.

// A part of the work on a ray. Only a range of one view sample may be a part of the suns, only a range
// of one sun may be a part of the light samples.
struct MarchRange {
  int first_view, end_view;
  int first_sun, end_sun;
  int first_light, end_light;
};

// Adds the light samples [first, end) to the columns of every constituent from a point to the light.
void add_columns_to_sun(Real h, Real mu, int first, int end, int samples,
                        INOUT_ARRAY(Real, column, MEDIA_SIZE)) {
  Real step_km = distance_to_top(h, mu) / Real(samples);
  for (int i = first; i < end; ++i) {
    Real altitude = altitude_after(h, mu, (Real(i) + 0.5) * step_km);
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] += step_km * relative_density(altitude, c);
  }
}

// Does `range` of the march. Columns from the camera to the sample and from the sample to the sun are
// carried from one call to the next; radiance is added to `inscatter`.
void march_view(Path path, MarchRange range, int view_samples, int light_samples,
                INOUT_ARRAY(Real, view_column, MEDIA_SIZE),
                INOUT_ARRAY(Real, light_column, MEDIA_SIZE),
                INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Real step_km = path.length_km / Real(view_samples);
  Real density[MEDIA_SIZE];
  Real column[MEDIA_SIZE];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  bool sun_varies = NEAR_SUN || MANY_SUNS;
  if (!sun_varies) {
    scattering_towards(
        scattering_angle(sun_ray(path.start, Vec3(0.0)).direction, path.direction),
        scattering_phase);
  }
  for (int i = range.first_view; i < range.end_view; ++i) {
    Real t = (Real(i) + 0.5) * step_km;
    Real h = altitude_after(path.altitude_km, path.mu, t);
    Vec3 position = path.start + path.direction * t;
    densities(h, density);
    for (int k = range.first_sun; k < range.end_sun; ++k) {
      SunRay sun = sun_ray(position, MANY_SUNS ? sun_offset(k) : Vec3(0.0));
      Real mu_sun = dot(position, sun.direction) / length(position);
      if (meets_ground(h, mu_sun)) continue;  // the planet's shadow
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        light_column[c] = range.first_light > 0 ? light_column[c] : 0.0;
      }
      add_columns_to_sun(h, mu_sun, range.first_light, range.end_light, light_samples,
                         light_column);
      if (range.end_light < light_samples) continue;
      if (sun_varies) {
        scattering_towards(scattering_angle(sun.direction, path.direction), scattering_phase);
      }
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        column[c] = view_column[c] + 0.5 * step_km * density[c] + light_column[c];
      }
      add_scattered(column, density, scattering_phase, step_km * sun.irradiance, k, inscatter);
    }
    if (range.end_sun < scene.disc_points || range.end_light < light_samples) continue;
    UNROLL for (int c = 0; c < MEDIA; ++c) view_column[c] += step_km * density[c];
  }
}

// The whole ray at once.
MarchRange whole_march(int view_samples, int light_samples) {
  MarchRange range;
  range.first_view = 0;
  range.end_view = view_samples;
  range.first_sun = 0;
  range.end_sun = scene.disc_points;
  range.first_light = 0;
  range.end_light = light_samples;
  return range;
}

// Radiance of the ground at the end of a path that meets it under one sun, before the air in front of
// it. In parts like the march: the light samples [first, end) are added to `light_column`, and the
// last part adds to `ground`.
void light_ground(Path path, MarchRange range, int light_samples,
                  INOUT_ARRAY(Real, light_column, MEDIA_SIZE),
                  INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  if (!path.meets_ground) return;
  Vec3 position = path.start + path.direction * path.length_km;
  for (int k = range.first_sun; k < range.end_sun; ++k) {
    SunRay sun = sun_ray(position, MANY_SUNS ? sun_offset(k) : Vec3(0.0));
    Real mu_sun = dot(position, sun.direction) / length(position);
    if (mu_sun <= 0.0) continue;
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      light_column[c] = range.first_light > 0 ? light_column[c] : 0.0;
    }
    add_columns_to_sun(0.0, mu_sun, range.first_light, range.end_light, light_samples,
                       light_column);
    if (range.end_light < light_samples) continue;
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      Vec4 light = transmittance_of(light_column, group) * (sun.irradiance * mu_sun);
      if (MANY_SUNS) light = light * sun_weight(k, group);
      ground[group] = ground[group] + lambertian(group) * light;
    }
  }
}
