// Where a ray lies in the shadow of the planet, or of the planet with its air up to some altitude: a
// cylinder, or behind a near sun a cone.

// The light of the sun's point k as the planet's centre sees it.
struct Light {
  Vec3 direction;      // unit, from the centre
  Real inverse_km;     // of its distance; 0 for parallel light
};

Light light_of_sun(int k) {
  Light light;
  Vec3 offset = MANY_SUNS ? sun_offset(k) : Vec3(0.0);
  SunRay ray = sun_ray(Vec3(0.0), offset);
  light.direction = ray.direction;
  light.inverse_km = NEAR_SUN ? 1.0 / ray.distance_km : 0.0;
  return light;
}

// Distances between which a path is dark; none where they are equal.
struct Shadow {
  Real enter_km;
  Real leave_km;
};

// With R the radius of the sphere that casts it, x from its centre, q = |x|^2 - R^2, s the direction to a light at the distance D, and
// m = x . s - R^2 / D: x is dark where m < 0 and (1 - R^2 / D^2) q < m^2. Along a ray both sides are
// quadratic in the distance. The dark side is convex, so a ray is dark once at most.
Shadow shadow_on(Path path, Light light, Real altitude) {
  Real radius = scene.planet_radius_km + altitude;
  Real r = scene.planet_radius_km + path.altitude_km;
  Real ratio = radius * light.inverse_km;
  Real open = (1.0 - ratio) * (1.0 + ratio);
  ScatteringAngle angle = scattering_angle(light.direction, path.direction);
  Real m = dot(path.start, light.direction) - radius * ratio;
  Real a = angle.one_minus_cosine * angle.one_plus_cosine - ratio * ratio;
  if (abs(a) < 1e-12) a = 1e-12;  // along the cone's side; the other end is far away
  Real b = open * r * path.mu - m * angle.cosine;
  Real q = (path.altitude_km - altitude) * (r + radius);
  Real c = open * q - m * m;
  Shadow shadow;
  shadow.enter_km = 0.0;
  shadow.leave_km = 0.0;
  Real d = b * b - a * c;
  if (d <= 0.0) return shadow;
  Real root = b > 0.0 ? -b - sqrt(d) : sqrt(d) - b;
  Real low = min(root / a, c / root);
  Real high = max(root / a, c / root);
  // A ray that is steeper than the cone enters or leaves it once.
  bool leaves = a > 0.0 || angle.cosine > 0.0;
  bool enters = a > 0.0 || angle.cosine <= 0.0;
  Real first_km = enters ? (a > 0.0 ? low : high) : 0.0;
  Real last_km = leaves ? (a > 0.0 ? high : low) : path.length_km;
  first_km = clamp(first_km, 0.0, path.length_km);
  last_km = clamp(last_km, 0.0, path.length_km);
  if (last_km <= first_km || m + angle.cosine * 0.5 * (first_km + last_km) >= 0.0) return shadow;
  shadow.enter_km = first_km;
  shadow.leave_km = last_km;
  return shadow;
}
