// What a ray from the camera sees, as columns and ratios. The columns of every constituent, exact, carry
// nearly all that varies over the sky; the ratios of the scattered light to
//
//   column x mean transmittance along the ray
//
// are what is left: smooth, so that a small table of them interpolates well. One ratio a scattering
// constituent, without its phase function, which is applied to each pixel: the aureole stays sharp. One
// more for all further orders.

// The part of a camera's ray that lies in the air.
SunlitRay view_ray(Path path, Vec3 to_sun) {
  SunlitRay ray;
  ray.altitude_km = min(path.altitude_km, scene.thickness_km);
  ray.mu = path.mu;
  ray.mu_sun = clamp(dot(path.start, to_sun) / length(path.start), -1.0, 1.0);
  ray.nu = dot(path.direction, to_sun);
  ray.length_km = path.length_km;
  ray.meets_ground = path.meets_ground;
  return ray;
}

// The march from the camera. Parallel light: columns of the constituents lit by the sun. A near sun, whose
// direction changes along the ray: the same times scattering coefficient, phase and irradiance.
// `path` and the `sun` (a point of the disc) matter to a near sun alone.
void march_view(SunlitRay ray, Path path, int sun, int samples, Real scale_height_km,
                bool all_orders, OUT_ARRAY(Real, column, MEDIA_SIZE),
                OUT_ARRAY(Vec4, once, MEDIA_GROUPS_SIZE),
                OUT_ARRAY(Vec4, further, GROUPS_SIZE)) {
  Vec4 density[MEDIA_SIZE];
  Vec4 column_to[MEDIA_SIZE];
  Vec4 light[GROUPS_SIZE];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  Vec4 lost[GROUPS_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    lost[group] = Vec4(0.0);
    further[group] = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) once[c * GROUPS_SIZE + group] = Vec4(0.0);
  }
  Shadow shadow;
  if (NEAR_SUN) {
    shadow = shadow_on(path, light_of_sun(sun), 0.0);
  } else {
    shadow = shadow_over(ray);
  }
  Panels panels = panels_along(ray, shadow, samples, scale_height_km);
  int count = number_of(panels);
  for (int p = 0; p < count; ++p) {
    Panel panel = panel_of(panels, p);
    pass_panel(ray, panel, column, density, column_to);
    for (int i = 0; i < 4; ++i) {
      Node node = node_of(ray, panel, i);
      Real irradiance = 1.0;
      if (NEAR_SUN) {
        Vec3 position = path.start + path.direction * node.distance_km;
        SunRay light_ray = sun_ray(position, MANY_SUNS ? sun_offset(sun) : Vec3(0.0));
        node.mu_sun = clamp(dot(position, light_ray.direction) / length(position), -1.0, 1.0);
        irradiance = light_ray.irradiance;
        scattering_towards(scattering_angle(light_ray.direction, path.direction),
                           scattering_phase);
      }
      if (panel.lit) transmittance_to_sun(node.altitude_km, node.mu_sun, light);
      MultiplePosition place;
      if (all_orders) place = multiple_position(node.altitude_km, node.mu_sun);
      UNROLL for (int group = 0; group < GROUPS; ++group) {
        Vec4 width_seen = seen_width(node, column_to, i, group);
        Vec4 seen = width_seen * irradiance;
        Vec4 scattered = Vec4(0.0);
        UNROLL for (int c = 0; c < MEDIA; ++c) {
          scattered = scattered + scattering(c, group) * density[c][i];
          lost[group] = lost[group] + extinction(c, group) * density[c][i] * width_seen;
          if (!panel.lit) continue;
          Vec4 arrived = seen * light[group] * density[c][i];
          if (NEAR_SUN) arrived = arrived * scattering_phase[c * GROUPS_SIZE + group];
          once[c * GROUPS_SIZE + group] = once[c * GROUPS_SIZE + group] + arrived;
        }
        if (!all_orders) continue;
        further[group] = further[group] + scattered * seen * multiple_scattering(place, group);
      }
    }
  }
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 kept = kept_of_found(lost[group], transmittance_of(column, group));
    further[group] = further[group] * kept;
    UNROLL for (int c = 0; c < MEDIA; ++c)
      once[c * GROUPS_SIZE + group] = once[c * GROUPS_SIZE + group] * kept;
  }
}

// The normalisation: for the columns of the march it makes the ratios, for the exact ones it gives back
// the radiance.
Vec4 column_seen(ARRAY(Real, column, MEDIA_SIZE), int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + extinction(c, group) * column[c];
  return mean_transmittances(depth);
}

Vec4 scattering_depth(ARRAY(Real, column, MEDIA_SIZE), int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + scattering(c, group) * column[c];
  return depth;
}

Vec4 ratio_of(Vec4 value, Vec4 to) { return value / max(to, Vec4(1e-30)); }

// Turns what march_view left into ratios.
void make_ratios(ARRAY(Real, column, MEDIA_SIZE), INOUT_ARRAY(Vec4, once, MEDIA_GROUPS_SIZE),
                 INOUT_ARRAY(Vec4, further, GROUPS_SIZE)) {
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 seen = column_seen(column, group);
    further[group] = ratio_of(further[group], scattering_depth(column, group) * seen);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      once[c * GROUPS_SIZE + group] =
          ratio_of(once[c * GROUPS_SIZE + group], column[c] * seen);
    }
  }
}

// Radiance scattered towards the camera, from ratios; `scattering_phase` is that of parallel light, and idle
// where a near sun's is in the ratios already.
Vec4 radiance_of(ARRAY(Real, column, MEDIA_SIZE), ARRAY(Vec4, once, MEDIA_GROUPS_SIZE),
                 ARRAY(Vec4, further, GROUPS_SIZE),
                 ARRAY(Vec4, scattering_phase, MEDIA_GROUPS_SIZE), int group) {
  Vec4 radiance = scattering_depth(column, group) * further[group];
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    Vec4 lit = once[c * GROUPS_SIZE + group] * forward_gain(c, group) * column[c];
    if (!NEAR_SUN) lit = lit * scattering_phase[c * GROUPS_SIZE + group];
    radiance = radiance + lit;
  }
  return radiance * column_seen(column, group);
}

// Radiance of the ground at the end of a ray under one point of the sun, before the air in front of it: lit by
// the sun, and by the sky whether the sun is up or not.
void light_ground(Path path, Vec3 offset, bool all_orders,
                  OUT_ARRAY(Vec4, radiance, GROUPS_SIZE)) {
  UNROLL for (int group = 0; group < GROUPS; ++group) radiance[group] = Vec4(0.0);
  if (!ends_on_ground(path)) return;
  Vec4 light[GROUPS_SIZE];
  Vec3 position = path.start + path.direction * path.length_km;
  SunRay sun = sun_ray(position, offset);
  Real mu_sun = clamp(dot(position, sun.direction) / length(position), -1.0, 1.0);
  transmittance_to_sun(0.0, max(mu_sun, 0.0), light);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 irradiance = light[group] * (scene.surface != 0 ? 0.0 : max(mu_sun, 0.0));
    if (all_orders) irradiance = irradiance + diffuse_irradiance(mu_sun, group);
    radiance[group] = left_by_ground(irradiance, group) * sun.irradiance;
  }
}

// What the air really leaves of the light, forward peak and all.
Vec4 true_transmittance(ARRAY(Real, column, MEDIA_SIZE), int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    Vec4 peak = scattering(c, group) * (forward_gain(c, group) - 1.0);
    depth = depth + (extinction(c, group) + peak) * column[c];
  }
  return exp(-depth);
}

// Exact columns along the rays from an altitude, by elevation: VIEW_NODES nodes from the horizon to the
// zenith, as many from the horizon to the nadir. So many that interpolation is exact to some 1e-5.
CONSTANT int VIEW_NODES = 2048;

void view_columns_of(SunlitRay ray, OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  NodePosition position = node_position(
      elevation_coordinate(ray.altitude_km, ray.mu, ray.meets_ground), VIEW_NODES);
  int node = position.node + (ray.meets_ground ? VIEW_NODES : 0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    column[c] = ray.length_km > 0.0 ? mix(READ_REAL(view_columns, node * MEDIA + c),
                                          READ_REAL(view_columns, (node + 1) * MEDIA + c), position.fraction)
                                    : 0.0;
  }
}
