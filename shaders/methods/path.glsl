// Light of two events and more by random walks from the camera, with the sun looked at from every
// vertex [e.g. Novak et al. 2018, Monte Carlo methods for volumetric light transport]. Whatever the
// proposals below are, each term is divided by the density that it was drawn with: they decide how
// noisy the result is, never what it is. All wavelengths of a batch share a walk.
//
// A walk carries its altitude and a frame that turns with the local vertical (z up), so that no
// position is ever the difference of two planetary radii.

struct Walk {
  Real altitude_km;
  Vec3 direction;   // unit, away from the camera
  Vec3 sun;         // to the sun: unit for parallel light, in km for a near one
  Real strength;    // throughput behind the first vertex, which roulette compares with
  int vertices;     // so far
};

// --- What the proposals know of the scene (engine/methods/path/guide.h) -----------------------------
//
// A scale height of what scatters; the share of directions that are drawn about the sun; by constituent
// its share in these; for tabulated phases the edges of cells in 1 - cos. Where GUIDED, also the light
// that there is for a walk to find, estimated coarsely for isotropic scattering at one wavelength,
// by altitude and zenith cosine of the sun: how much scatters at a point, how much arrives there by
// scattering, and from which directions.
CONSTANT int PHASE_CELLS = 128;
CONSTANT int LIGHT_ALTITUDES = 48;   // of the light that scatters at a point
CONSTANT int LIGHT_SUNS = 128;
CONSTANT int SKY_ALTITUDES = 12;     // of the light that arrives by scattering
CONSTANT int SKY_SUNS = 32;
CONSTANT int SKY_ELEVATIONS = 16;
CONSTANT int SKY_AZIMUTHS = 6;
CONSTANT int SKY_CELLS = SKY_ELEVATIONS * SKY_AZIMUTHS;

Real guide_scale_height_km() { return path_guide[0]; }
Real guide_sun_share() { return path_guide[1]; }
Real guide_peak_share(int c) { return path_guide[2 + c]; }
Real phase_cell_edge(int c, int edge) { return path_guide[2 + MEDIA + c * (PHASE_CELLS + 1) + edge]; }
int light_offset() { return 2 + MEDIA + MEDIA * (PHASE_CELLS + 1); }
int sky_offset() { return light_offset() + LIGHT_ALTITUDES * LIGHT_SUNS; }
Real sky_light(int place) { return path_guide[sky_offset() + place]; }
// Share of the cells before a cell in the sky of a place.
Real sky_share_before(int place, int cell) {
  return path_guide[sky_offset() + SKY_ALTITUDES * SKY_SUNS + place * (SKY_CELLS + 1) + cell];
}

Real sinh_inverse(Real x) {
  Real y = log(abs(x) + sqrt(x * x + 1.0));
  return x < 0.0 ? -y : y;
}

// Coordinates from 0 to 1. Suns are spread about the angle at which the shell's shadow ends.
Real altitude_coordinate(Real h) { return sqrt(max(h, 0.0) / scene.thickness_km); }
Real sun_coordinate(Real mu_sun) {
  Real radius = scene.planet_radius_km + scene.thickness_km;
  Real dip = sqrt(squared_height(scene.thickness_km)) / radius;
  Real lowest = sinh_inverse(-4.0);
  Real highest = sinh_inverse(2.0 / dip + 0.5);
  return clamp((sinh_inverse(2.0 * mu_sun / dip + 0.5) - lowest) / (highest - lowest), 0.0, 1.0);
}

int light_place(Real h, Real mu_sun) {
  int i = clamp(int(altitude_coordinate(h) * Real(LIGHT_ALTITUDES)), 0, LIGHT_ALTITUDES - 1);
  int j = clamp(int(sun_coordinate(mu_sun) * Real(LIGHT_SUNS)), 0, LIGHT_SUNS - 1);
  return i * LIGHT_SUNS + j;
}

int sky_place(Real h, Real mu_sun) {
  int i = clamp(int(altitude_coordinate(h) * Real(SKY_ALTITUDES)), 0, SKY_ALTITUDES - 1);
  int j = clamp(int(sun_coordinate(mu_sun) * Real(SKY_SUNS)), 0, SKY_SUNS - 1);
  return i * SKY_SUNS + j;
}

// --- Random numbers ----------------------------------------------------------------------------------

// [Jarzynski and Olano 2020, Hash functions for GPU rendering, JCGT 9(3): pcg4d]
UVec4 pcg4d(UVec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v = v ^ (v >> 16u);
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// What a walk's numbers depend on, and nothing else: not on how the work is cut.
struct Stream {
  Uint ray;
  Uint path;
  Uint seed;
};

// Four numbers in (0, 1), the same in float and in double.
Vec4 uniform_numbers(Stream stream, int index) {
  UVec4 bits = pcg4d(UVec4(stream.ray, stream.path, Uint(index), stream.seed));
  return (Vec4(bits >> 9u) + Vec4(0.5)) * (1.0 / 8388608.0);
}

// --- The frame that turns with the vertical ------------------------------------------------------

struct Turn {
  Vec2 towards;  // horizontal, unit
  Real cosine;   // of the angle at the planet's centre
  Real sine;
};

Turn turn_along(Real h, Vec3 direction, Real distance_km, Real new_h) {
  Turn turn;
  Vec2 horizontal = Vec2(direction.x, direction.y);
  Real sine = length(horizontal);
  turn.towards = sine > 0.0 ? horizontal / sine : Vec2(1.0, 0.0);
  Real new_radius = scene.planet_radius_km + new_h;
  turn.sine = distance_km * sine / new_radius;
  turn.cosine = (scene.planet_radius_km + h + distance_km * direction.z) / new_radius;
  return turn;
}

Vec3 turned(Turn turn, Vec3 v) {
  Real along = v.x * turn.towards.x + v.y * turn.towards.y;
  Real shift = along * turn.cosine - v.z * turn.sine - along;
  return Vec3(v.x + turn.towards.x * shift, v.y + turn.towards.y * shift,
              along * turn.sine + v.z * turn.cosine);
}

// `v` as seen in a frame whose z axis is `axis` [Duff et al. 2017, JCGT 6(1)].
Vec3 about_axis(Vec3 axis, Vec3 v) {
  Real side = axis.z < 0.0 ? -1.0 : 1.0;
  Real a = -1.0 / (side + axis.z);
  Real b = axis.x * axis.y * a;
  Vec3 across = Vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
  Vec3 other = Vec3(b, side + axis.y * axis.y * a, -axis.y);
  return normalize(across * v.x + other * v.y + axis * v.z);
}

// Unit vector at the angle with 1 - cos = deflection from the z axis.
Vec3 deflected(Real deflection, Real turn) {
  Real sine = sqrt(max(deflection * (2.0 - deflection), 0.0));
  return Vec3(sine * cos(2.0 * PI * turn), sine * sin(2.0 * PI * turn), 1.0 - deflection);
}

SunRay sun_from(Walk walk) {
  SunRay ray;
  ray.direction = walk.sun;
  ray.irradiance = 1.0;
  ray.distance_km = 0.0;
  if (NEAR_SUN) {
    ray.distance_km = length(walk.sun);
    ray.direction = walk.sun / ray.distance_km;
    Real ratio = scene.sun_distance_km / ray.distance_km;
    ray.irradiance = ratio * ratio;
  }
  return ray;
}

// --- How far: a density along the ray ---------------------------------------------------------------

// A ray in the shell, cut at its lowest point: down to there, and on from there.
struct Leg {
  Real low_h;
  Real back_mu;  // zenith cosine at the lowest point, looking back and looking on
  Real on_mu;
  Real back_km;
  Real on_km;
  bool meets_ground;
};

Leg leg_from(Real h, Real mu) {
  Leg leg;
  leg.meets_ground = meets_ground(h, mu);
  Real length_km = leg.meets_ground ? distance_to_ground(h, mu) : distance_to_top(h, mu);
  Real radius = scene.planet_radius_km + h;
  leg.back_km = min(max(-radius * mu, 0.0), length_km);
  leg.on_km = length_km - leg.back_km;
  leg.low_h = leg.meets_ground ? 0.0 : min(altitude_after(h, mu, leg.back_km), h);
  leg.back_mu = clamp(-(radius * mu + leg.back_km) / (scene.planet_radius_km + leg.low_h), 0.0, 1.0);
  leg.on_mu = max(mu, 0.0);
  return leg;
}

// Both parts are run through by x from 0 at the lowest point to 1: d = L x / (1 + (L / B) (1 - x)), even
// steps up to B, ever longer ones beyond it.
struct Stretch {
  Real length_km;
  Real bend;  // L / B
  Real mu;
};

Stretch stretch_of(Leg leg, bool back) {
  Stretch stretch;
  stretch.length_km = back ? leg.back_km : leg.on_km;
  stretch.mu = back ? leg.back_mu : leg.on_mu;
  Real scale = guide_scale_height_km();
  Real bend_km = 1.5 * sqrt(2.0 * scale * (scene.planet_radius_km + leg.low_h));
  if (bend_km * stretch.mu > 3.0 * scale) bend_km = 3.0 * scale / stretch.mu;
  stretch.bend = stretch.length_km / bend_km;
  return stretch;
}

Real stretched_distance(Stretch stretch, Real x) {
  return stretch.length_km * x / (1.0 + stretch.bend * (1.0 - x));
}

// Its derivative, km.
Real stretched_rate(Stretch stretch, Real x) {
  Real inverse = 1.0 / (1.0 + stretch.bend * (1.0 - x));
  return stretch.length_km * (1.0 + stretch.bend) * (inverse * inverse);
}

// A segment of one half, in the order of travel: where it begins and ends.
struct Segment {
  bool back;
  Real begin;
  Real end;
};

// Segment i of 2 SEGMENTS.
Segment segment_at(int i) {
  Segment segment;
  segment.back = i < SEGMENTS;
  int low = segment.back ? SEGMENTS - 1 - i : i - SEGMENTS;
  Real below = Real(low) / Real(SEGMENTS);
  Real above = Real(low + 1) / Real(SEGMENTS);
  segment.begin = segment.back ? above : below;
  segment.end = segment.back ? below : above;
  return segment;
}

// Part i of PARTS of a segment.
CONSTANT int PARTS = 8;
Segment part_at(Segment whole, int i) {
  Segment part;
  part.back = whole.back;
  part.begin = whole.begin + (whole.end - whole.begin) * (Real(i) / Real(PARTS));
  part.end = whole.begin + (whole.end - whole.begin) * (Real(i + 1) / Real(PARTS));
  return part;
}

// Mean of a density between two altitudes, given its values there: exact for exponentials.
Real mean_density(int c, Real from_h, Real to_h, Real from, Real to) {
  if (c < EXPONENTIALS) {
    Real exponent = (to_h - from_h) * medium(c).a;
    return abs(exponent) > 0.05 ? (from - to) / exponent : 0.5 * (from + to);
  }
  if (c >= MEDIA - TABLES - UNIFORMS && c < MEDIA - TABLES) return 1.0;
  return (from + 4.0 * relative_density(0.5 * (from_h + to_h), c) + to) / 6.0;
}

Real total(Vec4 v) { return v.x + v.y + v.z + v.w; }
Real smallest(Vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }

// The light that scatters at a point of a leg, at a distance from its lowest point. At the first vertex
// that of the sun is not wanted: it is the first order.
Real light_ahead(Walk walk, Leg leg, bool back, Real from_lowest_km, Real h) {
  SunRay sun = sun_from(walk);
  Real t = back ? leg.back_km - from_lowest_km : leg.back_km + from_lowest_km;
  Real radius = scene.planet_radius_km + walk.altitude_km;
  Real mu_sun = (radius * sun.direction.z + t * dot(walk.direction, sun.direction)) /
                (scene.planet_radius_km + h);
  if (walk.vertices == 0) return sky_light(sky_place(h, mu_sun));
  return path_guide[light_offset() + light_place(h, mu_sun)];
}

// A choice among segments by what they scatter of a walk's light, summed over the wavelengths: for each
// of these it is the balance heuristic [Veach 1997, section 9.2].
struct Choice {
  Segment segment;
  Real mass;    // that it scatters
  Real all;     // that all of them scatter
  Real slope;   // of the logarithm of its density along the segment
  Real pick;    // what is left of the random number where none was chosen
};

// Looks at the segments [first, end) of a leg, or at parts of one of them, and picks one: by mass, or
// the one that is `wanted` where that is not negative. `light` comes in at the first one and goes out
// behind the last; `light_there` is that at the chosen one.
Choice choose_segment(Walk walk, Leg leg, bool parts, Segment whole, int first, int end, Real pick, int wanted,
                      INOUT_ARRAY(Vec4, light, GROUPS_SIZE),
                      INOUT_ARRAY(Vec4, light_there, GROUPS_SIZE)) {
  Choice choice;
  choice.segment = whole;
  choice.mass = 0.0;
  choice.all = 0.0;
  choice.slope = 0.0;
  choice.pick = pick;
  Real density[MEDIA_SIZE];
  Vec4 depth[GROUPS_SIZE];
  Real h = 0.0;
  Real yield = 0.0;  // scattered light, 1/km
  for (int i = first; i < end; ++i) {
    Segment segment = segment_at(i);
    if (parts) segment = part_at(whole, i);
    Stretch stretch = stretch_of(leg, segment.back);
    Real begin_km = stretched_distance(stretch, segment.begin);
    Real end_km = stretched_distance(stretch, segment.end);
    if (i == first) {
      h = altitude_after(leg.low_h, stretch.mu, begin_km);
      densities(h, density);
      UNROLL for (int group = 0; group < GROUPS; ++group) {
        UNROLL for (int c = 0; c < MEDIA; ++c) {
          yield += density[c] * total(scattering(c, group) * light[group]);
        }
      }
    }
    Real next_h = altitude_after(leg.low_h, stretch.mu, end_km);
    Real column[MEDIA_SIZE];
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      Real next = relative_density(next_h, c);
      column[c] = mean_density(c, h, next_h, density[c], next) * abs(end_km - begin_km);
      density[c] = next;
    }
    Real thinnest = 1e30;
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      depth[group] = Vec4(0.0);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        depth[group] = depth[group] + extinction(c, group) * column[c];
      }
      thinnest = min(thinnest, smallest(depth[group]));
    }
    // The light at the end is kept apart from what all wavelengths lose, which may be beyond a float.
    Real left = exp(-thinnest);
    Real mass = 0.0;
    Real next_yield = 0.0;
    bool chosen_light = false;
    Vec4 light_here[GROUPS_SIZE];
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      Vec4 scattered = Vec4(0.0);
      Vec4 at_end = Vec4(0.0);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        scattered = scattered + scattering(c, group) * column[c];
        at_end = at_end + scattering(c, group) * density[c];
      }
      light_here[group] = light[group];
      Vec4 at_end_light = light[group] * exp(Vec4(thinnest) - depth[group]);
      light[group] = at_end_light * left;
      // light x (1 - e^-depth) / depth, also where depth is 0.
      mass += total(scattered * (light_here[group] * 1.000001 - light[group]) /
                    (depth[group] + 0.000001));
      next_yield += total(at_end_light * at_end);
    }
    if (GUIDED) mass *= light_ahead(walk, leg, segment.back, 0.5 * (begin_km + end_km), 0.5 * (h + next_h));
    choice.all += mass;
    bool by_mass = wanted < 0;
    if (by_mass ? choice.pick * choice.all < mass : i == wanted) {
      Real begin_rate = yield * stretched_rate(stretch, segment.begin);
      Real end_rate = next_yield * stretched_rate(stretch, segment.end);
      choice.segment = segment;
      choice.mass = mass;
      choice.slope = begin_rate > 0.0 && end_rate > 0.0
                         ? clamp(log(end_rate / begin_rate) - thinnest, -1e4, 1e4) : 0.0;
      if (by_mass) choice.pick = choice.pick * choice.all / mass;
      chosen_light = true;
    } else if (by_mass && choice.all > mass) {
      choice.pick = (choice.pick * choice.all - mass) / (choice.all - mass);
    }
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      if (chosen_light) light_there[group] = light_here[group];
    }
    h = next_h;
    yield = next_yield * left;
  }
  return choice;
}

// The point at u of a density proportional to e^(slope x) over [0, 1], and the density at x.
Real tilted_point(Real slope, Real u) {
  Real s = abs(slope);
  if (s < 0.05) return u;
  Real x = -log(1.0 - u * (1.0 - exp(-s))) / s;
  return slope < 0.0 ? x : 1.0 - x;
}

Real tilted_density(Real slope, Real x) {
  Real s = abs(slope);
  return s < 0.05 ? 1.0 : s * exp(-s * (slope < 0.0 ? x : 1.0 - x)) / (1.0 - exp(-s));
}

// Where a walk goes next.
struct Flight {
  bool ends;        // nothing lies ahead
  bool ground;
  Real distance_km;
  Real altitude_km;
  Real density;     // of the choice, 1/km; for the ground its probability
};

// Share of the choices that are even over all segments, so that no light has a density of nearly 0. It
// falls off along a walk, because a choice that leads nowhere costs a long walk all of its past.
Real even_share(int vertices) { return 0.1 / Real(1 + vertices * vertices); }

// Draws the next vertex with a density close to throughput x scattering x transmittance.
Flight choose_flight(Walk walk, Leg leg, ARRAY(Vec4, throughput, GROUPS_SIZE), Vec4 u) {
  int first = leg.back_km > 0.0 ? 0 : SEGMENTS;
  int end = leg.on_km > 0.0 ? 2 * SEGMENTS : SEGMENTS;
  int segments = end - first;
  Real evenly = even_share(walk.vertices);
  bool even = u.x < evenly;
  Real pick = even ? u.x / evenly : (u.x - evenly) / (1.0 - evenly);

  Vec4 light[GROUPS_SIZE];
  Vec4 light_there[GROUPS_SIZE];
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    light[group] = throughput[group];
    light_there[group] = throughput[group];
  }
  Segment none = segment_at(first);
  Choice choice = choose_segment(walk, leg, false, none, first, end, pick,
                                 even ? first + min(int(pick * Real(segments)), segments - 1) : -1,
                                 light, light_there);
  Real ground = 0.0;
  if (leg.meets_ground) {
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      ground += total(light[group] * ground_albedo(group));
    }
    if (GUIDED) ground *= light_ahead(walk, leg, true, 0.0, 0.0);
  }
  Real all = choice.all + ground;
  Flight flight;
  flight.ground = leg.meets_ground && (segments == 0 || (!even && choice.pick * all < ground));
  flight.ends = segments == 0 ? !(ground > 0.0) : !even && !(all > 0.0);
  flight.distance_km = leg.back_km + leg.on_km;
  flight.altitude_km = 0.0;
  flight.density = segments == 0 ? 1.0 : (1.0 - evenly) * ground / all;
  if (flight.ends || flight.ground) return flight;

  Choice part = choose_segment(walk, leg, true, choice.segment, 0, PARTS, u.y,
                               even ? min(int(u.y * Real(PARTS)), PARTS - 1) : -1, light_there, light);
  Stretch stretch = stretch_of(leg, part.segment.back);
  Real within = clamp(even ? u.z : tilted_point(part.slope, u.z), 0.0, 1.0);
  Real x = part.segment.begin + (part.segment.end - part.segment.begin) * within;
  Real from_lowest_km = stretched_distance(stretch, x);
  flight.distance_km = part.segment.back ? leg.back_km - from_lowest_km : leg.back_km + from_lowest_km;
  flight.altitude_km = clamp(altitude_after(leg.low_h, stretch.mu, from_lowest_km), 0.0,
                             scene.thickness_km);
  Real by_mass = all > 0.0 && part.all > 0.0
                     ? choice.mass / all * (part.mass / part.all) * Real(PARTS) : 0.0;
  Real density = (1.0 - evenly) * by_mass * tilted_density(part.slope, within) +
                 evenly / Real(segments);
  flight.density = density * Real(SEGMENTS) / stretched_rate(stretch, x);
  return flight;
}

// --- Where to: densities over directions ------------------------------------------------------------

// 1 - cos of an angle drawn from Henyey and Greenstein's phase function, without cancellation in the
// peak: their formula for cos with u counted from the forward end.
Real henyey_greenstein_deflection(Real g, Real u) {
  Real a = abs(g);
  Real scale = 1.0 / (1.0 + a - 2.0 * a * u);
  Real root = (1.0 - a) * (1.0 + a) * scale;
  Real deflection = clamp((1.0 - a) * u * (root + 1.0 - a) * scale, 0.0, 2.0);
  return g < 0.0 ? 2.0 - deflection : deflection;
}

// The same for 3 / (16 pi) (1 + cos^2): the root of cos^3 + 3 cos = z.
Real rayleigh_deflection(Real u) {
  Real z = 8.0 * u - 4.0;
  Real root = pow(0.5 * (abs(z) + sqrt(z * z + 4.0)), 1.0 / 3.0);
  Real cosine = root - 1.0 / root;
  return clamp(1.0 - (z < 0.0 ? -cosine : cosine), 0.0, 2.0);
}

// Tabulated phases are drawn from cells in 1 - cos that all have the same share of the light.
int phase_cell(int c, Real deflection) {
  int low = 0;
  int high = PHASE_CELLS;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (phase_cell_edge(c, middle) <= deflection) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

Real proposed_deflection(int c, Real u) {
  MediumData m = medium(c);
  if (m.phase == PHASE_HENYEY_GREENSTEIN || m.phase == PHASE_CORNETTE_SHANKS) {
    return henyey_greenstein_deflection(m.g, u);
  }
  if (m.phase == PHASE_TABLE) {
    int cell = min(int(u * Real(PHASE_CELLS)), PHASE_CELLS - 1);
    Real from = phase_cell_edge(c, cell);
    return from + (phase_cell_edge(c, cell + 1) - from) * (u * Real(PHASE_CELLS) - Real(cell));
  }
  return rayleigh_deflection(u);
}

// Their density, 1/sr.
Real proposed_phase(int c, ScatteringAngle angle) {
  MediumData m = medium(c);
  if (m.phase == PHASE_HENYEY_GREENSTEIN || m.phase == PHASE_CORNETTE_SHANKS) {
    return henyey_greenstein_phase(m.g, angle);
  }
  if (m.phase == PHASE_TABLE) {
    int cell = phase_cell(c, angle.one_minus_cosine);
    Real width = phase_cell_edge(c, cell + 1) - phase_cell_edge(c, cell);
    return 1.0 / (2.0 * PI * Real(PHASE_CELLS) * width);
  }
  return 3.0 / (16.0 * PI) * (1.0 + angle.cosine * angle.cosine);
}

// One of the constituents by `share` (which sum to 1), and its deflection.
Real mixed_deflection(ARRAY(Real, share, MEDIA_SIZE), Real pick, Real u) {
  Real deflection = 2.0 * u;
  Real sum = 0.0;
  bool found = false;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    sum += share[c];
    if (!found && share[c] > 0.0) {  // the last one too where rounding has kept the sum below 1
      deflection = proposed_deflection(c, u);
      found = pick < sum;
    }
  }
  return deflection;
}

Real mixed_phase(ARRAY(Real, share, MEDIA_SIZE), ScatteringAngle angle) {
  Real density = 0.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    if (share[c] > 0.0) density += share[c] * proposed_phase(c, angle);
  }
  return density;
}

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

Aim aim_at(Vec3 sun, Real h, Real sunlight) {
  Aim aim;
  Vec2 horizontal = Vec2(sun.x, sun.y);
  Real sine = length(horizontal);
  aim.azimuth = sine > 0.0 ? horizontal / sine : Vec2(1.0, 0.0);
  aim.sun = guide_sun_share() * sunlight;
  aim.place = GUIDED ? sky_place(h, sun.z) : 0;
  aim.sky = GUIDED && sky_light(aim.place) > 0.0 ? SKY_SHARE * (1.0 - aim.sun) : 0.0;
  return aim;
}

// Cells of the sky: y = asinh(SKY_BEND mu) / asinh(SKY_BEND) from -1 to 1, and the sine s of half the angle
// in azimuth from the sun. Within a cell both are even.
CONSTANT Real SKY_BEND = 10.0;
Real sky_elevation(Real mu) { return sinh_inverse(SKY_BEND * mu) / sinh_inverse(SKY_BEND); }
Real sky_cosine(Real y) {
  Real e = exp(abs(y) * sinh_inverse(SKY_BEND));
  Real mu = min((e - 1.0 / e) / (2.0 * SKY_BEND), 1.0);
  return y < 0.0 ? -mu : mu;
}

// dy ds over the solid angle, 1/sr; both sides of the sun's azimuth share it.
Real sky_density(Real mu, Real s) {
  Real up = SKY_BEND / (sinh_inverse(SKY_BEND) * sqrt(1.0 + SKY_BEND * SKY_BEND * (mu * mu)));
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

// --- A step of a walk -------------------------------------------------------------------------------

// The share of the light that leaves a vertex of those that a direction brings, for every wavelength:
// 1/(km sr) in air, 1/sr and with the cosine at the ground.
void scattered_share(Scatterer scatterer, Vec3 direction, ARRAY(Real, density, MEDIA_SIZE),
                     OUT_ARRAY(Vec4, scattered, GROUPS_SIZE)) {
  Vec4 phase[MEDIA_GROUPS_SIZE];
  scattering_towards(scattering_angle(direction, scatterer.incoming), phase);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    scattered[group] = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      scattered[group] = scattered[group] + phase[c * GROUPS_SIZE + group] * density[c];
    }
    if (scatterer.ground) scattered[group] = lambertian(group) * max(direction.z, 0.0);
  }
}

// Goes on to the next vertex; throughput is then that of the light which gets to it. False where
// the walk has left the shell.
bool fly(INOUT(Walk) walk, Vec4 u, INOUT_ARRAY(Vec4, throughput, GROUPS_SIZE), INOUT(Flight) flight) {
  Leg leg = leg_from(walk.altitude_km, walk.direction.z);
  flight = choose_flight(walk, leg, throughput, u);
  if (flight.ends || !(flight.density > 0.0)) return false;
  Real column[MEDIA_SIZE];
  columns_along(walk.altitude_km, walk.direction.z, flight.distance_km, column);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = throughput[group] * transmittance_of(column, group) / flight.density;
  }
  Turn turn = turn_along(walk.altitude_km, walk.direction, flight.distance_km, flight.altitude_km);
  if (NEAR_SUN) walk.sun = walk.sun - walk.direction * flight.distance_km;
  walk.sun = turned(turn, walk.sun);
  walk.direction = turned(turn, walk.direction);
  walk.altitude_km = flight.altitude_km;
  walk.vertices += 1;
  return true;
}

Real strongest(ARRAY(Vec4, throughput, GROUPS_SIZE)) {
  Real result = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 v = throughput[group];
    result = max(result, max(max(v.x, v.y), max(v.z, v.w)));
  }
  return result;
}

// One vertex more: flies there, adds what it scatters of the sun's light to `radiance` (from the second
// vertex on), and turns. False where the walk is over.
bool step_walk(INOUT(Walk) walk, Stream stream, int orders,
               INOUT_ARRAY(Vec4, throughput, GROUPS_SIZE), INOUT_ARRAY(Vec4, radiance, GROUPS_SIZE),
               INOUT(bool) ground_first) {
  Vec4 u = uniform_numbers(stream, 2 * walk.vertices);
  Vec4 v = uniform_numbers(stream, 2 * walk.vertices + 1);
  Flight flight;
  if (!fly(walk, u, throughput, flight)) return false;
  if (walk.vertices == 1) ground_first = flight.ground;

  Scatterer scatterer;
  scatterer.ground = flight.ground;
  scatterer.incoming = walk.direction;
  Real density[MEDIA_SIZE];
  densities(walk.altitude_km, density);
  Vec4 scattered[GROUPS_SIZE];
  SunRay sun = sun_from(walk);
  bool lit = !meets_ground(walk.altitude_km, sun.direction.z) &&
             !(flight.ground && sun.direction.z <= 0.0);
  Real carried = 0.0;
  Real sunlit = 0.0;
  if (lit) {
    Real column[MEDIA_SIZE];
    columns_to_top(walk.altitude_km, sun.direction.z, column);
    scattered_share(scatterer, sun.direction, density, scattered);
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      Vec4 light = throughput[group] * transmittance_of(column, group);
      carried += total(throughput[group]);
      sunlit += total(light);
      if (walk.vertices > 1) {
        radiance[group] = radiance[group] + light * scattered[group] * sun.irradiance;
      }
    }
  }
  if (walk.vertices == orders) return false;

  Real share[MEDIA_SIZE];
  Real sum = 0.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    share[c] = 0.0;
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      share[c] += density[c] * total(throughput[group] * scattering(c, group));
    }
    sum += share[c];
  }
  if (!flight.ground && !(sum > 0.0)) return false;
  UNROLL for (int c = 0; c < MEDIA; ++c) share[c] = share[c] / sum;

  Aim aim = aim_at(sun.direction, walk.altitude_km, carried > 0.0 ? min(sunlit / carried, 1.0) : 0.0);
  walk.direction = choose_direction(scatterer, aim, sun.direction, share, Vec4(v.x, v.y, v.z, u.w));
  scattered_share(scatterer, walk.direction, density, scattered);
  Real proposed = direction_density(scatterer, aim, sun.direction, share, walk.direction);
  if (!(proposed > 0.0)) return false;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = throughput[group] * scattered[group] / proposed;
  }

  // Roulette, on what the walk may find: towards the sun a forward peak lies ahead.
  Real strength = strongest(throughput);
  if (GUIDED) strength *= sky_light(aim.place) * (0.1 + from_sky_density(aim, walk.direction));
  if (aim.sun > 0.0) strength *= 1.0 + 4.0 * PI * peak_density(sun.direction, walk.direction);
  if (!(strength > 0.0)) return false;
  if (walk.vertices == 1) {
    walk.strength = strength;
    return true;
  }
  Real survives = min(strength / walk.strength, 1.0);
  if (v.w >= survives) return false;
  UNROLL for (int group = 0; group < GROUPS; ++group) throughput[group] = throughput[group] / survives;
  return true;
}

// At the start of a path, under one point of the sun.
Walk walk_from(Path path, Vec3 sun_point) {
  Walk walk;
  walk.altitude_km = path.altitude_km;
  walk.strength = 0.0;
  walk.vertices = 0;
  // From the frame at the camera's foot to that at the start.
  Turn turn;
  Vec2 horizontal = Vec2(path.start.x, path.start.y);
  Real offset = length(horizontal);
  turn.towards = offset > 0.0 ? horizontal / offset : Vec2(1.0, 0.0);
  turn.sine = offset / length(path.start);
  turn.cosine = path.start.z / length(path.start);
  Vec3 direction = turned(turn, path.direction);
  Real level = length(Vec2(direction.x, direction.y));
  // The zenith cosine as the path knows it: rays to the limb need all of its digits.
  Real scale = level > 0.0 ? sqrt(max((1.0 - path.mu) * (1.0 + path.mu), 0.0)) / level : 0.0;
  walk.direction = Vec3(direction.x * scale, direction.y * scale, path.mu);
  SunRay sun = sun_ray(path.start, sun_point);
  walk.sun = turned(turn, NEAR_SUN ? sun.direction * sun.distance_km : sun.direction);
  return walk;
}

// The walk `stream.path` of a ray, and what it carries at first: the light of one point of the disc
// stands for all of them.
Walk start_walk(Path path, Stream stream, OUT_ARRAY(Vec4, throughput, GROUPS_SIZE)) {
  int point = 0;
  if (MANY_SUNS) {
    Real u = uniform_numbers(stream, -1).x;
    point = min(int(u * Real(scene.disc_points)), scene.disc_points - 1);
  }
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = MANY_SUNS ? sun_weight(point, group) * Real(scene.disc_points) : Vec4(1.0);
  }
  return walk_from(path, MANY_SUNS ? sun_offset(point) : Vec3(0.0));
}
