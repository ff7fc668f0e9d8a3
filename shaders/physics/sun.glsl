// The sun as seen from a point of the air: a direction, and the share of the irradiance that the scene
// states. Light is parallel, or diverges from a point (or the points of a disc) at a finite distance.

struct SunRay {
  Vec3 direction;    // unit, to the light
  Real irradiance;   // relative to that at the distance of the planet's centre
  Real distance_km;  // to a near sun; idle for parallel light
};

// The light of one point of the disc at `position` (km, the planet's centre at the origin). The offset
// is in the plane of the disc, in units of the sine of its angular radius.
SunRay sun_ray(Vec3 position, Vec3 offset) {
  SunRay ray;
  if (NEAR_SUN) {
    Vec3 centre = Vec3(scene.sun_position.x, scene.sun_position.y, scene.sun_position.z);
    Vec3 to_point = centre + offset * (scene.sun_sin_radius * scene.sun_foot_km) - position;
    ray.distance_km = length(to_point);
    ray.direction = to_point / ray.distance_km;
    Real ratio = scene.sun_distance_km / ray.distance_km;
    ray.irradiance = ratio * ratio;
  } else {
    Vec3 centre = Vec3(scene.sun_direction.x, scene.sun_direction.y, scene.sun_direction.z);
    ray.direction = normalize(centre * sqrt(max(1.0 - dot(offset, offset) *
                                                          scene.sun_sin_radius *
                                                          scene.sun_sin_radius,
                                                0.0)) +
                              offset * scene.sun_sin_radius);
    ray.irradiance = 1.0;
    ray.distance_km = 0.0;
  }
  return ray;
}

// Radiance of the disc per unit irradiance, outside the air, 1/sr; 0 beside it. Its mean is
// 1 / (pi sin^2 of the angular radius); darkened to the limb by the power law of Hestroffer and
// Magnan [1998, eq. 4], mu^exponent, whose mean over the disc is 2 / (exponent + 2).
// `soft` is the width of a pixel in radians: the edge is drawn over one pixel.
Vec4 disc_radiance(Vec3 view, Vec3 camera_position, Vec4 exponent, Real soft) {
  SunRay centre = sun_ray(camera_position, Vec3(0.0));
  Real sine_radius = scene.sun_sin_radius;
  if (NEAR_SUN) sine_radius = min(sine_radius * scene.sun_foot_km / centre.distance_km, 1.0);
  ScatteringAngle angle = scattering_angle(centre.direction, view);
  Real sine = sqrt(angle.one_minus_cosine * angle.one_plus_cosine);
  Real coverage = clamp((sine_radius - sine) / max(soft, 1e-9) + 0.5, 0.0, 1.0);
  if (angle.cosine <= 0.0 || coverage <= 0.0 || sine_radius <= 0.0) return Vec4(0.0);
  Real x = min(sine / sine_radius, 1.0);
  Real mu = sqrt(max(1.0 - x * x, 1e-4));
  Real mean = centre.irradiance / (PI * sine_radius * sine_radius);
  return coverage * mean * 0.5 * (exponent + 2.0) * pow(Vec4(mu), exponent);
}
