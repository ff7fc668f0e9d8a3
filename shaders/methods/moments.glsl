// All orders of scattering from moments of the light. In a spherically symmetric air under one sun the
// diffuse radiance at a point depends on its altitude h, the sun's zenith cosine mu_s there, and the
// direction. A phase function of Legendre degree L sees only the radiance's spherical-harmonic moments
// up to L, so tables of those over (h, mu_s) hold all that the next order of scattering needs.
//
// Local frame at a point: z up, x towards the sun's horizontal projection. mu is the zenith cosine of a
// direction (of where light comes from), nu its cosine with the sun's axis: the direction from the
// planet's centre to the sun, which for parallel light is the sun's own. A near sun's light is
// symmetric about that axis too, so mu_s is always the axis' zenith cosine.

// --- Harmonics ---------------------------------------------------------------------------------------

CONSTANT int MOST_DEGREE = 12;   // of moments
CONSTANT int MOST_MOMENTS = 91;  // l = 0 to 12, m = 0 to l
CONSTANT int MOST_TERMS = 25;    // of a series in Legendre polynomials

// Loops over l and m below are over a square, and skip what is not in its triangle: drivers unroll loops
// inside others only where their ends are constant, and what is not unrolled goes through memory.
int moment_index(int l, int m) { return l * (l + 1) / 2 + m; }

// The m-th derivatives of the Legendre polynomials over that of P_m, P_l^(m)(mu) / (2 m - 1)!!: associated
// Legendre functions without their sin^m, and of a size that halves hold [Abramowitz and Stegun 1964, eqs. 8.5.3 and
// 8.6.6]. This is that of the degree l + 1 after those of l and l - 1; that of m is 1, and below it they are 0.
Real next_zenith_polynomial(Real mu, int l, int m, Real p, Real before) {
  return (Real(2 * l + 1) / Real(l + 1 - m)) * mu * p - (Real(l + m) / Real(l + 1 - m)) * before;
}

void zenith_polynomials(Real mu, int degree, OUT_ARRAY(Real, p, MOST_MOMENTS)) {
  UNROLL for (int m = 0; m <= degree; ++m) {
    UNROLL for (int l = 0; l <= degree; ++l) {
      if (l == m) p[moment_index(l, m)] = 1.0;
      if (l > m) {
        Real before = l > m + 1 ? p[moment_index(l - 2, m)] : 0.0;
        p[moment_index(l, m)] = next_zenith_polynomial(mu, l - 1, m, p[moment_index(l - 1, m)], before);
      }
    }
  }
}

// c_m = (sin of the direction's times sin of the axis' zenith angle)^m cos(m azimuth), without
// trigonometry: Chebyshev's recurrence from c_0 = 1.
struct AzimuthRecurrence {
  Real first;
  Real square;
};

AzimuthRecurrence azimuth_recurrence(Real mu, Real mu_s, Real nu) {
  AzimuthRecurrence recurrence;
  recurrence.first = nu - mu * mu_s;
  recurrence.square = (1.0 - mu * mu) * (1.0 - mu_s * mu_s);
  return recurrence;
}

// c_(m + 1) after c_m and the one before.
Real next_azimuth_term(AzimuthRecurrence by, int m, Real c, Real before) {
  return m == 0 ? by.first : 2.0 * by.first * c - by.square * before;
}

void azimuth_terms(Real mu, Real mu_s, Real nu, int degree, OUT_ARRAY(Real, c, MOST_DEGREE + 1)) {
  AzimuthRecurrence by = azimuth_recurrence(mu, mu_s, nu);
  c[0] = 1.0;
  UNROLL for (int m = 1; m <= degree; ++m) c[m] = next_azimuth_term(by, m - 1, c[m - 1], c[max(m - 2, 0)]);
}

// What makes the addition theorem P_l(cos of an angle) = 4 pi / (2 l + 1) sum over m of
// norm_lm p_lm(mu) p_lm(mu') (sin sin')^m cos(m (phi - phi')) true, p_lm from zenith_polynomials.
Real harmonic_norm(int l, int m) {
  Real norm = Real(2 * l + 1) / (4.0 * PI) * (m > 0 ? 2.0 : 1.0);
  UNROLL for (int i = 1; i <= MOST_DEGREE; ++i) {
    int k = l - m + 2 * i;
    if (i <= m) norm *= Real((2 * i - 1) * (2 * i - 1)) / Real((k - 1) * k);
  }
  return norm;
}

// Legendre polynomials P_0 to P_degree.
void legendre_polynomials(Real x, int degree, OUT_ARRAY(Real, p, MOST_TERMS)) {
  p[0] = 1.0;
  UNROLL for (int l = 1; l <= degree; ++l) {
    p[l] = l == 1 ? x : (Real(2 * l - 1) * x * p[l - 1] - Real(l - 1) * p[max(l - 2, 0)]) / Real(l);
  }
}

// --- Where the tables have their nodes ---------------------------------------------------------------

struct MomentGrid {
  Real altitude_power;    // h = thickness y^power, y uniform
  Real sun_shift_km;      // height of the air that carries the light into the shadow
  Real sun_width;         // of the fine spacing at the shadow's edge, a sine
  Real reach_sine;        // of the angle behind the edge at which the tables end
  Real reach_cosine;
  Real parallax_sine;     // of the planet's radius seen from a near sun; 0 for parallel light
  Real parallax_cosine;
  int altitudes;
  int suns;
};

Real altitude_of_node(MomentGrid grid, Real node) {
  return scene.thickness_km * pow(node / Real(grid.altitudes - 1), grid.altitude_power);
}

Real node_of_altitude(MomentGrid grid, Real h) {
  Real share = clamp(h / scene.thickness_km, 0.0, 1.0);
  return Real(grid.altitudes - 1) * pow(share, 1.0 / grid.altitude_power);
}

// The sine of the angle by which the horizon lies below the horizontal at an altitude.
Real dip_sine(Real h) { return sqrt(squared_height(h)) / (scene.planet_radius_km + h); }
Real dip_cosine(Real h) { return scene.planet_radius_km / (scene.planet_radius_km + h); }

// The nodes over the sun's cosine are dense about the edge of the planet's shadow, which lies at the
// elevation -dip(h): uniform in asinh((mu_s + centre) / width).
struct SunRange {
  Real centre;
  Real low;    // asinh at the lowest and the highest node
  Real high;
};

// Next to the axis itself sin^m of its zenith angle leaves no digits to divide by.
CONSTANT Real MOST_SUN_COSINE = 0.995;

SunRange sun_range(MomentGrid grid, Real h) {
  SunRange range;
  Real shifted = h + grid.sun_shift_km;
  range.centre = dip_sine(shifted) * grid.parallax_cosine - dip_cosine(shifted) * grid.parallax_sine;
  Real sine = dip_sine(h);
  Real cosine = dip_cosine(h);
  bool night_has_no_end = cosine * grid.reach_cosine - sine * grid.reach_sine <= 0.0;
  Real lowest = -(sine * grid.reach_cosine + cosine * grid.reach_sine);
  if (night_has_no_end) lowest = -1.0;
  lowest = max(lowest, -MOST_SUN_COSINE);
  range.low = inverse_sinh((lowest + range.centre) / grid.sun_width);
  range.high = inverse_sinh((MOST_SUN_COSINE + range.centre) / grid.sun_width);
  return range;
}

Real sun_of_node(MomentGrid grid, SunRange range, Real node) {
  Real u = range.low + (range.high - range.low) * node / Real(grid.suns - 1);
  Real growth = exp(u);
  return clamp(0.5 * (growth - 1.0 / growth) * grid.sun_width - range.centre, -1.0, 1.0);
}

Real node_of_sun(MomentGrid grid, SunRange range, Real mu_s) {
  Real u = inverse_sinh((mu_s + range.centre) / grid.sun_width);
  return Real(grid.suns - 1) * max((u - range.low) / (range.high - range.low), 0.0);
}

// Four neighbouring nodes and their weights: Lagrange's cubic, one-sided at the ends.
struct CubicTaps {
  int first;
  Vec4 weights;
  Vec2 outer;   // weights of the first and the last where they lie outside of the two about the place, else 0
};

CubicTaps cubic_taps(Real node, int nodes) {
  CubicTaps taps;
  taps.first = clamp(int(floor(node)) - 1, 0, nodes - 4);
  Real t = node - Real(taps.first);
  Real t1 = t - 1.0;
  Real t2 = t - 2.0;
  Real t3 = t - 3.0;
  taps.weights = Vec4(-t1 * t2 * t3 / 6.0, 0.5 * t * t2 * t3, -0.5 * t * t1 * t3, t * t1 * t2 / 6.0);
  taps.outer = Vec2(t < 1.0 ? 0.0 : taps.weights.x, t > 2.0 ? 0.0 : taps.weights.w);
  return taps;
}

Vec4 cubic_sum(ARRAY(Vec4, value, 4), CubicTaps taps) {
  return value[0] * taps.weights.x + value[1] * taps.weights.y + value[2] * taps.weights.z +
         value[3] * taps.weights.w;
}

// The same, kept from overshooting where the values fall off a cliff, as light does where night begins: on
// either side the curve may bend by four times what it bends on the other and a half more, which is never
// reached where a logarithm or a ratio is smooth, and stays within a tenth of their range, and a quarter: of a
// range of fifteen decades a tenth is light out of nothing.
Vec4 limited_sum(ARRAY(Vec4, value, 4), CubicTaps taps) {
  Vec4 low = min(min(value[0], value[1]), min(value[2], value[3]));
  Vec4 high = max(max(value[0], value[1]), max(value[2], value[3]));
  Vec4 margin = min(0.1 * (high - low), Vec4(0.25));
  Vec4 first = value[0] - 2.0 * value[1] + value[2];
  Vec4 last = value[1] - 2.0 * value[2] + value[3];
  Vec4 most = 0.5 + 4.0 * min(abs(first), abs(last));
  Vec4 sum = cubic_sum(value, taps) + (clamp(first, -most, most) - first) * taps.outer.x +
             (clamp(last, -most, most) - last) * taps.outer.y;
  return clamp(sum, low - margin, high + margin);
}

// --- Directions ---------------------------------------------------------------------------------------

// Zenith cosines are split at the local horizon, where radiance jumps, and gathered there.
struct ZenithNode {
  Real mu;
  Real weight;  // d mu
};

ZenithNode zenith_node(Real h, bool down, Real x, Real weight) {
  ZenithNode node;
  Real horizon = -dip_sine(h);
  Real span = down ? -1.0 - horizon : 1.0 - horizon;
  node.mu = horizon + span * x * x;
  node.weight = abs(span) * 2.0 * x * weight;
  return node;
}

// --- Rays -------------------------------------------------------------------------------------------

// Nodes of a ray are even in a root of the distance from where most of its light comes: its lowest
// point, where the air is densest, or in thick air its start. It is the cube root, or a higher one that
// puts nodes within the free path of light.
struct Cuts {
  Real origin_km;    // where they are densest, from the start
  Real power;
  Real from;         // roots of the signed distances of start and end from there
  Real to;
};

Real signed_root(Real x, Real power) {
  Real magnitude = abs(x) > 0.0 ? pow(abs(x), 1.0 / power) : 0.0;
  return x < 0.0 ? -magnitude : magnitude;
}

// Optical depths of a ray, at its start's extinction, from which on light from beyond its lowest point
// counts for little.
CONSTANT Real THICK = 8.0;

Cuts cuts_of(Real h, Real mu, Real length_km) {
  Cuts cuts;
  Real depths = largest_extinction(h) * length_km;
  Real lowest_km = clamp(-(scene.planet_radius_km + h) * mu, 0.0, length_km);
  cuts.origin_km = depths > THICK ? 0.0 : lowest_km;
  cuts.power = cuts.origin_km > 0.0 ? 3.0 : max(3.0, log(max(depths, 1.0)) / log(2.5));
  cuts.from = signed_root(-cuts.origin_km, cuts.power);
  cuts.to = signed_root(length_km - cuts.origin_km, cuts.power);
  return cuts;
}

// The same nodes for a part of the ray.
Cuts part_of(Cuts whole, Real from_km, Real to_km) {
  Cuts part = whole;
  part.from = signed_root(from_km - whole.origin_km, whole.power);
  part.to = signed_root(to_km - whole.origin_km, whole.power);
  return part;
}

// Zenith cosine of a ray's direction after the distance t, at the altitude `altitude`.
Real mu_after(Real h, Real mu, Real t, Real altitude) {
  return clamp(((scene.planet_radius_km + h) * mu + t) / (scene.planet_radius_km + altitude), -1.0, 1.0);
}

// Zenith cosine of the axis after the distance t along a ray with the cosine nu to it.
Real axis_after(Real h, Real mu_s, Real nu, Real t, Real altitude) {
  return clamp(((scene.planet_radius_km + h) * mu_s + t * nu) / (scene.planet_radius_km + altitude), -1.0,
               1.0);
}

// A node of a Gauss rule at the share x of the way.
struct RayNode {
  Real t_km;      // from the start
  Real width_km;  // that it stands for
};

RayNode ray_node(Cuts cuts, Real x, Real weight) {
  Real span = cuts.to - cuts.from;
  Real root = cuts.from + span * x;
  Real magnitude = abs(root);
  Real slope = magnitude > 0.0 ? pow(magnitude, cuts.power - 1.0) : 0.0;
  RayNode node;
  node.t_km = max(cuts.origin_km + root * slope, 0.0);
  node.width_km = cuts.power * slope * span * weight;
  return node;
}

// In thick air the nodes' sum of extinction, transmittance and width is off from 1 - transmittance, what the ray
// takes out of a beam, and where it is more each order of scattering makes light of nothing. This is what brings
// the sum there. Nodes that missed nearly all of the air stay so.
Vec4 balance_of(Vec4 sum, Vec4 depth) {
  Vec4 taken = depth * mean_transmittances(depth);
  const Real most = 2.0;
  return min(max(taken, Vec4(1e-30)) / max(sum, Vec4(1e-30)), Vec4(most));
}

// --- Azimuths -----------------------------------------------------------------------------------------
// Along a ray the axis' zenith cosine changes with the azimuth, in proportion to its cosine x. What a node of
// the ray sends, beside the terms in azimuth that are known exactly, follows that smoothly: one to three
// Chebyshev points in x stand for all azimuths.

// How many, where that many spacings of the sun's nodes lie between the azimuths 0 and pi.
int azimuth_points(Real spacings) { return spacings > 1.0 ? 3 : spacings > 0.3 ? 2 : 1; }
Real most_spacings(int points) { return points == 1 ? 0.3 : 1.0; }

Real azimuth_point(int p, int points) {
  return points == 1 ? 0.0 : cos(PI * (Real(p) + 0.5) / Real(points));
}

// Part of the way at which one rule changes over to the next, by their shares: light would jump where a scene
// that changes a little changed its rule at once.
CONSTANT Real RULE_CHANGE = 0.05;

// From 0 to 1 as the spacings come to where the next rule has taken over.
Real share_of_next(Real spacings, Real most) {
  return clamp(1.0 - (most / max(spacings, Real(1e-6)) - 1.0) / RULE_CHANGE, 0.0, 1.0);
}

// Those points and, where the rule changes, the next more numerous ones beside them.
struct AzimuthRule {
  int points;
  int more;
  Real share_of_more;
};

AzimuthRule azimuth_rule(Real spacings) {
  AzimuthRule rule;
  rule.points = azimuth_points(spacings);
  int next = azimuth_points(spacings * (1.0 + RULE_CHANGE));
  rule.more = next > rule.points ? next : 0;
  rule.share_of_more = rule.more > 0 ? share_of_next(spacings, most_spacings(rule.points)) : 0.0;
  return rule;
}

// How much of order one is traced at each azimuth by itself. In twilight it falls by powers of ten from one end
// of x to the other, and no short series of it stays positive: at the sun's elevation -6 deg that made an error
// of 7 %, where now it is 1 %.
Real share_of_each_azimuth(Real spacings) { return share_of_next(spacings, 2.5); }

// What the value at a point adds to the coefficients of a series in T_0, T_1 and T_2.
Vec3 chebyshev_shares(Real point, int points) {
  Real mean = 1.0 / Real(points);
  Real bend = points > 2 ? 2.0 * mean * (2.0 * point * point - 1.0) : 0.0;
  return Vec3(mean, 2.0 * mean * point, bend);
}

// One of a rule's points, and its shares.
struct AzimuthSample {
  Real x;
  Vec3 shares;
};

AzimuthSample azimuth_sample(AzimuthRule rule, int p) {
  bool more = p >= rule.points;
  int points = more ? rule.more : rule.points;
  AzimuthSample at;
  at.x = azimuth_point(more ? p - rule.points : p, points);
  at.shares = chebyshev_shares(at.x, points) * (more ? rule.share_of_more : 1.0 - rule.share_of_more);
  return at;
}

// That series at x.
Vec4 chebyshev_sum(Vec4 mean, Vec4 slope, Vec4 bend, Real x) {
  return mean + slope * x + bend * (2.0 * x * x - 1.0);
}

// Weight of the value at a point in the polynomial through all of them, at x.
Real chebyshev_weight(Real point, int points, Real x) {
  Real weight = 1.0;
  Vec2 before = Vec2(1.0, 1.0);
  Vec2 term = Vec2(point, x);
  for (int q = 1; q < points; ++q) {
    weight += 2.0 * term.x * term.y;
    Vec2 next = 2.0 * Vec2(point, x) * term - before;
    before = term;
    term = next;
  }
  return weight / Real(points);
}

// --- Tables -------------------------------------------------------------------------------------------
// Kept are the logarithm of the lowest moment, the mean radiance times the normalisation, which changes
// by decades through twilight, and the ratios of all others to it, which don't.

CONSTANT Real DARKEST = 1e-27;  // per unit irradiance; what is less counts as this
CONSTANT Real DARK = 1e-20;     // what that comes to, over all nodes of a ray and hundreds of orders

Vec4 moment_logarithm(Vec4 moment) { return log(max(moment, Vec4(DARKEST))); }

// The light that a logarithm stands for; what the darkest comes to is none.
Vec4 light_of_logarithm(Vec4 logarithm) { return max(exp(logarithm) - Vec4(DARK), Vec4(0.0)); }

Vec4 moment_ratio(Vec4 moment, Vec4 lowest) {
  return Vec4(lowest.x > DARKEST ? moment.x / lowest.x : 0.0,
              lowest.y > DARKEST ? moment.y / lowest.y : 0.0,
              lowest.z > DARKEST ? moment.z / lowest.z : 0.0,
              lowest.w > DARKEST ? moment.w / lowest.w : 0.0);
}

// --- The sky of a camera --------------------------------------------------------------------------------
// What is scattered more than once is smooth in direction: a table over elevation, dense about the horizon,
// and azimuth from the sun's axis, one for rays that meet the ground and one for those that don't.

// Sines of half the angles to the zenith and to the nadir, both precise for directions near either.
Vec2 half_sines(Real mu, Real sine) {
  Real up = sqrt(max(0.5 * (1.0 - mu), 0.0));
  Real down = sqrt(max(0.5 * (1.0 + mu), 0.0));
  return mu < 0.0 ? Vec2(up, 0.5 * sine / up) : Vec2(0.5 * sine / down, down);
}

Vec2 horizon_half_sines() {
  Real h = scene.camera_altitude_km;
  return half_sines(-dip_sine(h), dip_cosine(h));
}

// Half sines at the edge of the air, for a camera above it.
Vec2 limb_half_sines() {
  Real sine = (scene.planet_radius_km + scene.thickness_km) /
              (scene.planet_radius_km + scene.camera_altitude_km);
  return half_sines(-sqrt(max(1.0 - sine * sine, 0.0)), sine);
}

// Seen from low above it, the ground next to the horizon changes within about the horizon's own dip: there
// shares are even in asinh(x / this), x the root of the share of the half sine.
Real ground_bend() { return 2.0 * sqrt(max(dip_sine(scene.camera_altitude_km), 1e-6)); }

// From 0 at the horizon to 1 at the nadir, the zenith, or the edge of the air.
Real elevation_share(Vec3 direction, bool ground) {
  Vec2 half_sine = half_sines(direction.z, length(Vec2(direction.x, direction.y)));
  Vec2 horizon = horizon_half_sines();
  Real square = 1.0 - half_sine.x / horizon.x;
  if (ground) square = 1.0 - half_sine.y / horizon.y;
  if (!ground && scene.camera_altitude_km > scene.thickness_km) {
    square = (half_sine.y - horizon.y) / (limb_half_sines().y - horizon.y);
  }
  Real share = sqrt(clamp(square, 0.0, 1.0));
  return ground ? asinh(share / ground_bend()) / asinh(1.0 / ground_bend()) : share;
}

// The direction with an elevation's share and an azimuth from `forward`, a horizontal unit vector.
Vec3 direction_of_share(Real share, bool ground, Real azimuth, Vec2 forward) {
  Vec2 horizon = horizon_half_sines();
  if (ground) share = ground_bend() * sinh(share * asinh(1.0 / ground_bend()));
  Real up = horizon.x * (1.0 - share * share);
  Real down = sqrt(max(1.0 - up * up, 0.0));
  bool by_down = ground || scene.camera_altitude_km > scene.thickness_km;
  if (by_down) {
    down = ground ? horizon.y * (1.0 - share * share)
                  : horizon.y + (limb_half_sines().y - horizon.y) * share * share;
    up = sqrt(max(1.0 - down * down, 0.0));
  }
  Real sine = 2.0 * up * down;
  Real mu = by_down ? 2.0 * down * down - 1.0 : 1.0 - 2.0 * up * up;
  Vec2 right = Vec2(-forward.y, forward.x);
  Vec2 horizontal = (forward * cos(azimuth) + right * sin(azimuth)) * sine;
  return Vec3(horizontal.x, horizontal.y, mu);
}

// The horizontal direction of the sun's axis; any where that is vertical.
Vec2 axis_forward(Vec3 axis) {
  Vec2 horizontal = Vec2(axis.x, axis.y);
  Real sine = length(horizontal);
  return sine > 1e-6 ? horizontal / sine : Vec2(1.0, 0.0);
}

// 0 to pi.
Real azimuth_from(Vec2 forward, Vec3 direction) {
  Real along = forward.x * direction.x + forward.y * direction.y;
  Real across = abs(forward.x * direction.y - forward.y * direction.x);
  return across + abs(along) > 0.0 ? atan(across, along) : 0.0;
}

// Unit, from the planet's centre to the sun.
Vec3 sun_axis() {
  Vec3 position = Vec3(scene.sun_position.x, scene.sun_position.y, scene.sun_position.z);
  Vec3 direction = Vec3(scene.sun_direction.x, scene.sun_direction.y, scene.sun_direction.z);
  return NEAR_SUN ? position / scene.sun_distance_km : direction;
}
