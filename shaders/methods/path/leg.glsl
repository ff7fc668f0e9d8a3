// A walk's ray to its end, as segments that are short where the air is dense.

// A ray in the shell, cut at its lowest point: down to there, and on from there.
struct Leg {
  Real low_h;
  Real back_mu;  // zenith cosine at the lowest point, looking back and looking on
  Real on_mu;
  Real back_km;
  Real on_km;
  bool meets_ground;
};

// To the end of the shell, or as far as `end_km`.
Leg leg_from(Real h, Real mu, Real end_km) {
  Leg leg;
  leg.meets_ground = meets_ground(h, mu);
  Real length_km = leg.meets_ground ? distance_to_ground(h, mu) : distance_to_top(h, mu);
  leg.meets_ground = leg.meets_ground && length_km < end_km;
  length_km = min(length_km, end_km);
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

// Part i of `count` of a segment.
Segment part_at(Segment whole, int i, int count) {
  Segment part;
  part.back = whole.back;
  part.begin = whole.begin + (whole.end - whole.begin) * (Real(i) / Real(count));
  part.end = whole.begin + (whole.end - whole.begin) * (Real(i + 1) / Real(count));
  return part;
}

CONSTANT int PARTS = 8;
