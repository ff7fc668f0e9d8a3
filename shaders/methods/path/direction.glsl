// Where a walk goes from a vertex: a mixture of what the scatterer favours and of where the light is.

// Light comes straight from the sun, and with a low sun from some parts of the sky only. These directions
// are proposed beside those that the scatterer favours: without the first, a walk that happens to fly
// towards the sun would carry the whole forward peak of its next vertex.
struct Aim {
  Real sun;      // shares of the proposals; the rest follows the scatterer
  Real sky;
  int place;     // whose sky
  Vec2 azimuth;  // towards the sun, unit
};

CONSTANT Real SKY_SHARE = 0.6;

// The part without a forward peak of what the constituents scatter by share. The sky is proposed for this
// alone: a peak's light stays within the peak, and of the walks that follow it through haze few would be
// left, with 1 / (1 - SKY_SHARE) times as much after every turn. Standard errors in haze of optical depth 1,
// g 0.8 and the sun at 5 deg are half of those with the sky proposed for all.
Real scattered_widely(ARRAY(Real, share, MEDIA_SIZE)) {
  Real wide = 1.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    if (guide_peak_share(c) > 0.0) wide -= share[c];
  }
  return max(wide, 0.0);
}

// `wide`: the part of a vertex that scatters widely.
Aim aim_at(Vec3 sun, Real h, Real sunlight, Real wide) {
  Aim aim;
  Vec2 horizontal = Vec2(sun.x, sun.y);
  Real sine = length(horizontal);
  aim.azimuth = sine > 0.0 ? horizontal / sine : Vec2(1.0, 0.0);
  aim.sun = guide_sun_share() * sunlight;
  aim.place = GUIDED ? sky_place(h, sun.z) : 0;
  aim.sky = GUIDED && sky_light(aim.place) > 0.0 ? SKY_SHARE * wide * (1.0 - aim.sun) : 0.0;
  return aim;
}

// Cells of the sky: y = asinh(SKY_BEND mu) / asinh(SKY_BEND) from -1 to 1, and the sine s of half the angle
// in azimuth from the sun. Within a cell both are even.
CONSTANT Real SKY_BEND = 10.0;
Real sky_elevation(Real mu) { return inverse_sinh(SKY_BEND * mu) / inverse_sinh(SKY_BEND); }
Real sky_cosine(Real y) {
  Real e = exp(abs(y) * inverse_sinh(SKY_BEND));
  Real mu = min((e - 1.0 / e) / (2.0 * SKY_BEND), 1.0);
  return y < 0.0 ? -mu : mu;
}

// dy ds over the solid angle, 1/sr; both sides of the sun's azimuth share it.
Real sky_density(Real mu, Real s) {
  Real up = SKY_BEND / (inverse_sinh(SKY_BEND) * sqrt(1.0 + SKY_BEND * SKY_BEND * (mu * mu)));
  Real around = 0.25 * sqrt(max(1.0 - s * s, 0.0));
  return up * around;
}

// Towards a point of a cell; u.z tells the sides apart.
Vec3 sky_direction(Vec2 azimuth, int cell, Vec2 u, bool left) {
  Real y = 2.0 * (Real(cell / SKY_AZIMUTHS) + u.x) / Real(SKY_ELEVATIONS) - 1.0;
  Real s = (Real(cell % SKY_AZIMUTHS) + u.y) / Real(SKY_AZIMUTHS);
  Real mu = sky_cosine(y);
  Real level = sqrt(max(1.0 - mu * mu, 0.0));
  Real cosine = 1.0 - 2.0 * s * s;
  Real sine = 2.0 * s * sqrt(max(1.0 - s * s, 0.0));
  if (left) sine = -sine;
  return Vec3(level * (azimuth.x * cosine - azimuth.y * sine),
              level * (azimuth.y * cosine + azimuth.x * sine), mu);
}

Vec3 from_sky(Aim aim, Real pick, Real side, Vec2 u) {
  int low = 0;
  int high = SKY_CELLS;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (sky_share_before(aim.place, middle) <= pick) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return sky_direction(aim.azimuth, low, u, side < 0.5);
}

// Its density, 1/sr.
Real from_sky_density(Aim aim, Vec3 direction) {
  Real level = length(Vec2(direction.x, direction.y));
  Real cosine = level > 0.0
                    ? (aim.azimuth.x * direction.x + aim.azimuth.y * direction.y) / level : 1.0;
  Real s = sqrt(clamp(0.5 - 0.5 * cosine, 0.0, 1.0));
  Real y = 0.5 + 0.5 * sky_elevation(direction.z);
  int row = clamp(int(y * Real(SKY_ELEVATIONS)), 0, SKY_ELEVATIONS - 1);
  int column = clamp(int(s * Real(SKY_AZIMUTHS)), 0, SKY_AZIMUTHS - 1);
  int cell = row * SKY_AZIMUTHS + column;
  Real share = sky_share_before(aim.place, cell + 1) - sky_share_before(aim.place, cell);
  return share * Real(SKY_CELLS / 2) * sky_density(direction.z, s);
}

// Of directions drawn about the sun.
Real peak_density(Vec3 sun, Vec3 direction) {
  Real share[MEDIA_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) share[c] = guide_peak_share(c);
  return mixed_phase(share, scattering_angle(direction, sun));
}

// What scatters at a vertex: the ground, or the constituents by share.
struct Scatterer {
  bool ground;
  Vec3 incoming;  // direction of the walk that arrives
  GroundPlace place;  // of ground that is not the same everywhere
};

Vec3 choose_direction(Scatterer scatterer, Aim aim, Vec3 sun, ARRAY(Real, share, MEDIA_SIZE), Vec4 u) {
  if (u.x < aim.sun) {
    Real own[MEDIA_SIZE];
    UNROLL for (int c = 0; c < MEDIA; ++c) own[c] = guide_peak_share(c);
    return about_axis(sun, deflected(mixed_deflection(own, u.x / aim.sun, u.y), u.z));
  }
  Real rest = u.x - aim.sun;
  if (rest < aim.sky) return from_sky(aim, rest / aim.sky, u.w, Vec2(u.y, u.z));
  rest = (rest - aim.sky) / (1.0 - aim.sun - aim.sky);
  if (scatterer.ground) {
    Real cosine = sqrt(u.y);
    Real sine = sqrt(1.0 - u.y);
    return Vec3(sine * cos(2.0 * PI * u.z), sine * sin(2.0 * PI * u.z), cosine);
  }
  return about_axis(scatterer.incoming, deflected(mixed_deflection(share, rest, u.y), u.z));
}

Real direction_density(Scatterer scatterer, Aim aim, Vec3 sun, ARRAY(Real, share, MEDIA_SIZE),
                       Vec3 direction) {
  Real own = scatterer.ground ? max(direction.z, 0.0) / PI
                              : mixed_phase(share, scattering_angle(direction, scatterer.incoming));
  Real density = (1.0 - aim.sun - aim.sky) * own;
  if (aim.sun > 0.0) density += aim.sun * peak_density(sun, direction);
  if (aim.sky > 0.0) density += aim.sky * from_sky_density(aim, direction);
  return density;
}
