// How far a walk goes: its next vertex is drawn with a density close to throughput x scattering x
// transmittance, from masses of the segments before it, then of parts of the one chosen, and within
// that part exponentially. Transmittances are found exactly afterwards.

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

// Slope of the logarithm of a density that goes from one value to another times e^-depth.
Real slope_between(Real begin, Real end, Real depth) {
  return begin > 0.0 && end > 0.0 ? clamp(log(end / begin) - depth, -1e4, 1e4) : 0.0;
}

// The light that scatters at a point of a leg, at a distance from its lowest point. At the first vertex
// that of the sun is not wanted: it is the first order.
Real light_ahead(Walk walk, Leg leg, bool back, Real from_lowest_km, Real h) {
  SunRay sun = sun_from(walk);
  Real t = back ? leg.back_km - from_lowest_km : leg.back_km + from_lowest_km;
  Real radius = scene.planet_radius_km + walk.altitude_km;
  Real mu_sun = (radius * sun.direction.z + t * dot(walk.direction, sun.direction)) /
                (scene.planet_radius_km + h);
  if (walk.vertices == 0) return sky_light(sky_place(h, mu_sun));
  return READ_REAL(path_guide, light_offset() + light_place(h, mu_sun));
}

// A choice among segments by what they scatter of a walk's light, summed over the wavelengths: for each
// of these it is the balance heuristic [Veach 1997, section 9.2].
struct Choice {
  Segment segment;
  Real mass;    // that it scatters
  Real all;     // that all of them scatter
  Real slope;   // of the logarithm of its density along the segment
  Real thickest;  // its depth, of the wavelength with the largest
  Real pick;    // what is left of the random number where none was chosen
};

// Parts in which a chosen segment is looked at again: none where its density is nearly even.
int parts_of(Choice choice) {
  return TABLES > 0 || choice.thickest > 0.5 || abs(choice.slope) > 1.0 ? PARTS : 1;
}

// Goes through a segment: densities at its end, and columns of all constituents in between.
void pass_segment(Real h, Real next_h, Real width_km, INOUT_ARRAY(Real, density, MEDIA_SIZE),
                  OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    Real next = relative_density(next_h, c);
    column[c] = mean_density(c, h, next_h, density[c], next) * width_km;
    density[c] = next;
  }
}

// Light that densities scatter out of a beam, 1/km, summed over the wavelengths.
Real yield_of(ARRAY(Real, density, MEDIA_SIZE), ARRAY(Vec4, light, GROUPS_SIZE)) {
  Real yield = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      yield += density[c] * total(scattering(c, group) * light[group]);
    }
  }
  return yield;
}

// What a segment does to a beam.
struct Loss {
  Real scattered;   // in the whole of it
  Real yield;       // at its end, 1/km, before the loss `thinnest`
  Real thickest;
  Real thinnest;    // depth that all wavelengths have in common: e^-thinnest may be beyond a float
};

Loss lose_light(ARRAY(Real, column, MEDIA_SIZE), ARRAY(Real, density_at_end, MEDIA_SIZE),
                INOUT_ARRAY(Vec4, light, GROUPS_SIZE)) {
  Vec4 depth[GROUPS_SIZE];
  Loss loss;
  loss.thinnest = 1e30;
  loss.thickest = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    depth[group] = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      depth[group] = depth[group] + extinction(c, group) * column[c];
    }
    loss.thinnest = min(loss.thinnest, smallest(depth[group]));
    loss.thickest = max(loss.thickest, -smallest(-depth[group]));
  }
  Real common_part = exp(-loss.thinnest);
  loss.scattered = 0.0;
  Vec4 left[GROUPS_SIZE];
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    left[group] = light[group] * exp(Vec4(loss.thinnest) - depth[group]);
    Vec4 scattering_depth = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      scattering_depth = scattering_depth + scattering(c, group) * column[c];
    }
    // light x scattering depth x (1 - e^-depth) / depth, also where the depth is 0.
    loss.scattered += total(scattering_depth * (light[group] * 1.000001 - left[group] * common_part) /
                            (depth[group] + 0.000001));
    light[group] = left[group] * common_part;
  }
  loss.yield = yield_of(density_at_end, left);
  return loss;
}

// Looks at the segments [first, end) of a leg, or where `parts` is not 0 at those of one of them, and picks one: by mass, or
// the one that is `wanted` where that is not negative. `light` comes in at the first one and goes out
// behind the last; `light_there` is that at the chosen one.
Choice choose_segment(Walk walk, Leg leg, int parts, Segment whole, int first, int end, Real pick,
                      int wanted, INOUT_ARRAY(Vec4, light, GROUPS_SIZE),
                      INOUT_ARRAY(Vec4, light_there, GROUPS_SIZE)) {
  Choice choice;
  choice.segment = whole;
  choice.mass = 0.0;
  choice.all = 0.0;
  choice.slope = 0.0;
  choice.thickest = 0.0;
  choice.pick = pick;
  Real density[MEDIA_SIZE];
  Real column[MEDIA_SIZE];
  Vec4 light_here[GROUPS_SIZE];
  Real h = 0.0;
  Real yield = 0.0;
  for (int i = first; i < end; ++i) {
    Segment segment = segment_at(i);
    if (parts > 0) segment = part_at(whole, i, parts);
    Stretch stretch = stretch_of(leg, segment.back);
    Real begin_km = stretched_distance(stretch, segment.begin);
    Real end_km = stretched_distance(stretch, segment.end);
    if (i == first) {
      h = altitude_after(leg.low_h, stretch.mu, begin_km);
      densities(h, density);
      yield = yield_of(density, light);
    }
    Real next_h = altitude_after(leg.low_h, stretch.mu, end_km);
    UNROLL for (int group = 0; group < GROUPS; ++group) light_here[group] = light[group];
    pass_segment(h, next_h, abs(end_km - begin_km), density, column);
    Loss loss = lose_light(column, density, light);
    Real mass = loss.scattered;
    if (GUIDED) {
      mass *= light_ahead(walk, leg, segment.back, 0.5 * (begin_km + end_km), 0.5 * (h + next_h));
    }
    choice.all += mass;
    bool by_mass = wanted < 0;
    if (by_mass ? choice.pick * choice.all < mass : i == wanted) {
      if (by_mass) choice.pick = choice.pick * choice.all / mass;
      choice.segment = segment;
      choice.mass = mass;
      choice.thickest = loss.thickest;
      choice.slope = slope_between(yield * stretched_rate(stretch, segment.begin),
                                   loss.yield * stretched_rate(stretch, segment.end), loss.thinnest);
      UNROLL for (int group = 0; group < GROUPS; ++group) light_there[group] = light_here[group];
    } else if (by_mass && choice.all > mass) {
      choice.pick = (choice.pick * choice.all - mass) / (choice.all - mass);
    }
    h = next_h;
    yield = loss.yield * exp(-loss.thinnest);
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

// To the ground at the end of the leg, with a probability; 0 where a walk has nowhere to go.
Flight to_end(Leg leg, Real density) {
  Flight flight;
  flight.ends = !(density > 0.0);
  flight.ground = true;
  flight.distance_km = leg.back_km + leg.on_km;
  flight.altitude_km = 0.0;
  flight.density = density;
  return flight;
}

// To a point of a segment, found from u; `by_mass` is the density of the segment itself among all, times
// the share of the choices by mass, `evenly` that of even ones.
Flight to_segment(Leg leg, Choice choice, Real by_mass, Real evenly, Real u, bool even) {
  Segment segment = choice.segment;
  Stretch stretch = stretch_of(leg, segment.back);
  Real within = clamp(even ? u : tilted_point(choice.slope, u), 0.0, 1.0);
  Real x = segment.begin + (segment.end - segment.begin) * within;
  Real from_lowest_km = stretched_distance(stretch, x);
  Flight flight;
  flight.ends = false;
  flight.ground = false;
  flight.distance_km = segment.back ? leg.back_km - from_lowest_km : leg.back_km + from_lowest_km;
  flight.altitude_km = clamp(altitude_after(leg.low_h, stretch.mu, from_lowest_km), 0.0,
                             scene.thickness_km);
  flight.density = (by_mass * tilted_density(choice.slope, within) + evenly) /
                   stretched_rate(stretch, x);
  return flight;
}

// Draws the next vertex.
Flight choose_flight(Walk walk, Leg leg, ARRAY(Vec4, throughput, GROUPS_SIZE), Vec4 u) {
  int first = leg.back_km > 0.0 ? 0 : SEGMENTS;
  int end = leg.on_km > 0.0 ? 2 * SEGMENTS : SEGMENTS;
  int segments = end - first;
  Real evenly = segments > 0 ? even_share(walk.vertices) : 0.0;
  bool even = u.x < evenly;
  Real pick = even ? u.x / evenly : (u.x - evenly) / (1.0 - evenly);

  Vec4 light[GROUPS_SIZE];
  Vec4 light_there[GROUPS_SIZE];
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    light[group] = throughput[group];
    light_there[group] = throughput[group];
  }
  Choice choice;
  choice.segment = segment_at(first);
  Real by_mass = 1.0 - evenly;
  // First among the segments, then among the parts of one: a loop, so that the code is there once.
  for (int level = 0; level < 2; ++level) {
    int count = level == 0 ? segments : parts_of(choice);
    int wanted = even ? min(int(pick * Real(count)), count - 1) : -1;
    choice = choose_segment(walk, leg, level == 0 ? 0 : count, choice.segment, level == 0 ? first : 0,
                            level == 0 ? end : count, pick, level == 0 && even ? first + wanted : wanted, light,
                            light_there);
    Real all = choice.all;
    if (level == 0 && leg.meets_ground) {
      Real ground = 0.0;
      UNROLL for (int group = 0; group < GROUPS; ++group) {
        ground += total(light[group] * ground_albedo(group));
      }
      if (GUIDED) ground *= light_ahead(walk, leg, true, 0.0, 0.0);
      all += ground;
      if (!even && choice.pick * all < ground) return to_end(leg, by_mass * ground / all);
    }
    if (segments == 0 || (!even && !(all > 0.0))) return to_end(leg, 0.0);
    by_mass = all > 0.0 ? by_mass * (choice.mass / all) * Real(level == 0 ? SEGMENTS : count) : 0.0;
    pick = u.y;
    UNROLL for (int group = 0; group < GROUPS; ++group) light[group] = light_there[group];
  }
  return to_segment(leg, choice, by_mass, evenly * Real(SEGMENTS) / Real(segments), u.z, even);
}
