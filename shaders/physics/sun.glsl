// The sun as seen from a point of the air: a direction, and the share of the irradiance that the scene
// states. Light is parallel, or diverges from a point (or the points of a disc) at a finite distance.
// The points of a near sun's disc are all as far from the camera's foot point.

struct SunRay {
  Vec3 direction;    // unit, to the light
  Real irradiance;   // relative to that at the distance of the planet's centre
  Real distance_km;  // to a near sun; idle for parallel light
};

// The light of one point of the disc at `position` (km, the planet's centre at the origin). The offset
// is in the plane of the disc, in units of the sine of its angular radius.
SunRay sun_ray(Vec3 position, Vec3 offset) {
  SunRay ray;
  Vec3 axis = Vec3(scene.sun_direction.x, scene.sun_direction.y, scene.sun_direction.z);
  Real squared_sine = dot(offset, offset) * scene.sun_sin_radius * scene.sun_sin_radius;
  Real cosine = sqrt(max(Real(1.0) - squared_sine, Real(0.0)));
  if (NEAR_SUN) {
    Vec3 centre = Vec3(scene.sun_position.x, scene.sun_position.y, scene.sun_position.z);
    Vec3 from_centre = offset * scene.sun_sin_radius - axis * (squared_sine / (Real(1.0) + cosine));
    Vec3 to_point = centre + from_centre * scene.sun_foot_km - position;
    ray.distance_km = length(to_point);
    ray.direction = to_point / ray.distance_km;
    Real ratio = scene.sun_distance_km / ray.distance_km;
    ray.irradiance = ratio * ratio;
  } else {
    ray.direction = normalize(axis * cosine + offset * scene.sun_sin_radius);
    ray.irradiance = 1.0;
    ray.distance_km = 0.0;
  }
  return ray;
}

// Sine of the disc's angular radius as seen from a point.
Real disc_sine(SunRay centre) {
  return NEAR_SUN ? min(scene.sun_sin_radius * scene.sun_foot_km / centre.distance_km, Real(1.0))
                  : scene.sun_sin_radius;
}

// The sine over which the edge of the drawn disc fades: one pixel of `soft` radians, and up to two where the disc
// is smaller than that, for it to be seen wherever in a pixel it stands.
Real disc_fade(Real disc_sine, Real soft) { return max(soft, Real(2.0) * soft - disc_sine); }

// Light of the drawn disc at a sine from its centre, 1 in the middle of a wide one: darkened to the limb by the
// power law of Hestroffer and Magnan [1998, eq. 4], mu^exponent, with the limb where the fading ends.
Vec4 disc_shape(Real sine, Real disc_sine, Real fade, Vec4 exponent) {
  Real limb = disc_sine + Real(0.5) * fade;
  Real x = sine / limb;
  Real squared_mu = max((1.0 - x) * (1.0 + x), 1e-12);
  return clamp((limb - sine) / max(fade, 1e-12), 0.0, 1.0) * pow(Vec4(squared_mu), 0.5 * exponent);
}

// Radiance of the disc per unit irradiance, outside the air, 1/sr; 0 beside it. `scale`, of the same
// wavelengths, is what makes its projected solid angle's integral the irradiance (pack.cpp).
Vec4 disc_radiance(Vec3 view, Vec3 camera_position, Vec4 exponent, Vec4 scale, Real soft) {
  SunRay centre = sun_ray(camera_position, Vec3(0.0));
  ScatteringAngle angle = scattering_angle(centre.direction, view);
  if (angle.cosine <= 0.0) return Vec4(0.0);
  Real sine = sqrt(angle.one_minus_cosine * angle.one_plus_cosine);
  Real radius = disc_sine(centre);
  return disc_shape(sine, radius, disc_fade(radius, soft), exponent) * scale * centre.irradiance;
}
