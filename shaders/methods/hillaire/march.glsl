// The march along a ray through sunlit air. What it does not do, because it is where others lose light:
// sample a step at its end, drop the last part of a ray, or step across the edge of the planet's shadow.

// A ray in the shell and the sun over it, as cosines: of the zenith angles of ray and sun at its start, and
// of the angle between the two.
struct SunlitRay {
  Real altitude_km;
  Real mu;
  Real mu_sun;
  Real nu;
  Real length_km;
  bool meets_ground;
};

SunlitRay sunlit_ray(Real h, Real mu, bool meets_ground, Real mu_sun, Real nu) {
  SunlitRay ray;
  ray.altitude_km = h;
  ray.mu = mu;
  ray.mu_sun = mu_sun;
  ray.nu = nu;
  ray.meets_ground = meets_ground;
  ray.length_km = meets_ground ? distance_to_ground(h, mu) : distance_to_top(h, mu);
  return ray;
}

// Cosine of the sun's zenith angle at the distance t, where the altitude is h.
Real sun_cosine_after(SunlitRay ray, Real h, Real t) {
  Real along = (scene.planet_radius_km + ray.altitude_km) * ray.mu_sun + t * ray.nu;
  return clamp(along / (scene.planet_radius_km + h), -1.0, 1.0);
}

// The part of a ray that lies in the planet's shadow under parallel light: inside the cylinder
// |x|^2 - (x . sun)^2 = R^2, behind the planet. Empty where both ends are equal.
struct ShadowedPart {
  Real from_km;
  Real to_km;
};

ShadowedPart shadowed_part(SunlitRay ray) {
  ShadowedPart part;
  Real radius = scene.planet_radius_km + ray.altitude_km;
  Real along = radius * ray.mu_sun;
  Real a = (1.0 - ray.nu) * (1.0 + ray.nu);
  Real b = radius * ray.mu - along * ray.nu;
  Real c = squared_height(ray.altitude_km) - along * along;
  Real discriminant = b * b - a * c;
  part.from_km = 0.0;
  part.to_km = 0.0;
  if (a < 1e-6) {  // along the light: in the shadow everywhere or nowhere
    if (c < 0.0 && along < 0.0) part.to_km = ray.length_km;
    return part;
  }
  if (discriminant <= 0.0) return part;
  Real q = -(b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
  Real one = q / a;
  Real other = c / q;
  Real from_km = clamp(min(one, other), 0.0, ray.length_km);
  Real to_km = clamp(max(one, other), 0.0, ray.length_km);
  if (along + 0.5 * (from_km + to_km) * ray.nu >= 0.0) return part;  // in front of the planet
  part.from_km = from_km;
  part.to_km = to_km;
  return part;
}

// Steps uniform in u, distance = bend sinh(u) from the lowest point: short and even within a scale height
// of it, in proportion to the distance beyond. The ray is cut at the edges of the shadow.
struct Steps {
  Real low_km;   // distance of the lowest point
  Real bend_km;
  Vec4 edges;    // u of the start, the shadow's two edges, the end
  Vec3 size;     // of a step in u, before, in and behind the shadow
  int before;    // numbers of steps
  int in_shadow;
  int behind;
};

int share_of(int samples, Real part, Real whole) {
  if (part <= 0.0) return 0;
  return max(1, int(Real(samples) * part / whole + 0.5));
}

Steps steps_along(SunlitRay ray, ShadowedPart shadow, int samples, Real scale_height_km) {
  Steps steps;
  Real along = (scene.planet_radius_km + ray.altitude_km) * ray.mu;
  steps.low_km = clamp(-along, 0.0, ray.length_km);
  Real low_radius =
      scene.planet_radius_km + altitude_after(ray.altitude_km, ray.mu, steps.low_km);
  Real low_mu = abs(along + steps.low_km) / low_radius;
  steps.bend_km = 2.0 * sqrt(2.0 * scale_height_km * low_radius);
  if (steps.bend_km * low_mu > 2.0 * scale_height_km) {
    steps.bend_km = 2.0 * scale_height_km / low_mu;
  }
  steps.edges = asinh((Vec4(0.0, shadow.from_km, shadow.to_km, ray.length_km) - steps.low_km) /
                      steps.bend_km);
  Real whole = steps.edges.w - steps.edges.x;
  Vec3 parts = Vec3(steps.edges.y - steps.edges.x, steps.edges.z - steps.edges.y,
                    steps.edges.w - steps.edges.z);
  steps.before = share_of(samples, parts.x, whole);
  steps.in_shadow = share_of(samples, parts.y, whole);
  steps.behind = share_of(samples, parts.z, whole);
  steps.size = parts / max(Vec3(Real(steps.before), Real(steps.in_shadow), Real(steps.behind)),
                           Vec3(1.0));
  return steps;
}

int number_of(Steps steps) { return steps.before + steps.in_shadow + steps.behind; }

struct Step {
  Real middle_km;  // distance
  Real width_km;
  bool lit;
};

Step step_of(Steps steps, int i) {
  Step result;
  int into_shadow = i - steps.before;
  int behind = into_shadow - steps.in_shadow;
  Real edge = steps.edges.x;
  Real size = steps.size.x;
  int k = i;
  if (into_shadow >= 0) {
    edge = steps.edges.y;
    size = steps.size.y;
    k = into_shadow;
  }
  if (behind >= 0) {
    edge = steps.edges.z;
    size = steps.size.z;
    k = behind;
  }
  Real u = edge + (Real(k) + 0.5) * size;
  result.middle_km = max(steps.low_km + steps.bend_km * sinh(u), 0.0);
  // bend (sinh(u + size / 2) - sinh(u - size / 2)): the widths add up to the ray.
  result.width_km = 2.0 * steps.bend_km * cosh(u) * sinh(0.5 * size);
  result.lit = into_shadow < 0 || behind >= 0;
  return result;
}

// Mean of exp(-x) for x from 0 to an optical depth.
Real mean_transmittance(Real depth) {
  return depth > 0.03 ? (1.0 - exp(-depth)) / depth
                      : 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth / 24.0));
}

Vec4 mean_transmittances(Vec4 depth) {
  return Vec4(mean_transmittance(depth.x), mean_transmittance(depth.y),
              mean_transmittance(depth.z), mean_transmittance(depth.w));
}

// Goes through a step of even density: `seen_km` is the integral over it of the transmittance to the
// ray's start [Hillaire 2015], and `transmittance` that to its end.
void pass_step(ARRAY(Real, density, MEDIA_SIZE), Real width_km,
               INOUT_ARRAY(Vec4, transmittance, GROUPS_SIZE),
               OUT_ARRAY(Vec4, seen_km, GROUPS_SIZE)) {
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 depth = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      depth = depth + extinction(c, group) * (density[c] * width_km);
    }
    seen_km[group] = transmittance[group] * mean_transmittances(depth) * width_km;
    transmittance[group] = transmittance[group] * exp(-depth);
  }
}

// From a point that the ground does not hide from the sun.
void transmittance_to_sun(Real h, Real mu_sun, OUT_ARRAY(Vec4, light, GROUPS_SIZE)) {
  OpticalDepthPosition position = optical_depth_position(h, mu_sun);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    light[group] = exp(-tabulated_optical_depth(position, group));
  }
}
