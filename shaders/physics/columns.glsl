// Columns (km of density 1) along rays, by quadrature. They do not depend on the wavelength, and eight
// well-placed nodes are a hundred times as good as a bilinear fetch from a table.
//
// Every ray is cut at its lowest point into parts that are looked at from their low end upwards:
// altitude h, zenith cosine mu >= 0. There the distance d is d = B t / sqrt(1 - t^2), t uniform: linear
// up to B, ever longer steps beyond, where a density that falls by e over its scale height H is
// gone. B = min(6 H / mu, 3 sqrt(2 H r)) holds the relative error of an exponential column below
// 1.3e-5 for any length, elevation, and H from 0.2 km to 40 km on an Earth (tests/laws/columns_test.cpp).

struct StretchedPath {
  Real bend_km;    // B
  Real end;        // t at the end of the path
};

StretchedPath stretched_path(Real h, Real mu, Real length_km, Real scale_height_km) {
  StretchedPath path;
  Real radius = scene.planet_radius_km + h;
  path.bend_km = 3.0 * sqrt(2.0 * scale_height_km * radius);
  if (path.bend_km * mu > 6.0 * scale_height_km) path.bend_km = 6.0 * scale_height_km / mu;
  path.end = length_km / sqrt(length_km * length_km + path.bend_km * path.bend_km);
  return path;
}

// Distance from the path's start, and the length that a node stands for, of the node at x in [0, 1] with
// a rule's weight.
struct StretchedNode {
  Real distance_km;
  Real width_km;
};

StretchedNode stretched_node(StretchedPath path, Real x, Real weight) {
  StretchedNode node;
  Real t = path.end * x;
  Real inverse_root = 1.0 / sqrt(1.0 - t * t);
  node.distance_km = path.bend_km * t * inverse_root;
  node.width_km =
      weight * path.bend_km * path.end * (inverse_root * inverse_root * inverse_root);
  return node;
}

// Distance on the way up at which a ray comes to an altitude, within its length; 0 for one that it starts above,
// be that below the planet's centre.
Real distance_up_to(Real altitude, Real h, Real mu, Real length_km) {
  Real b = (scene.planet_radius_km + h) * mu;
  Real c = max(altitude - h, 0.0) * (2.0 * scene.planet_radius_km + altitude + h);
  return c > 0.0 ? min(c / (sqrt(b * b + c) + b), length_km) : 0.0;
}

// With four nodes for eight, and three for four, an Earth's columns are within 6e-3: enough where they dim
// light that is averaged over many rays.
Real column_node(int i) { return COLUMN_NODES == 8 ? gauss8_node(i) : gauss4_node(i); }
Real column_weight(int i) { return COLUMN_NODES == 8 ? gauss8_weight(i) : gauss4_weight(i); }
Real plain_node(int i) { return COLUMN_NODES == 8 ? gauss4_node(i) : gauss3_node(i); }
Real plain_weight(int i) { return COLUMN_NODES == 8 ? gauss4_weight(i) : gauss3_weight(i); }

// Of a density that falls off with a scale height, however slowly.
Real stretched_column(Real h, Real mu, Real length_km, Real scale_height_km, int c) {
  StretchedPath path = stretched_path(h, mu, length_km, scale_height_km);
  Real column = 0.0;
  UNROLL for (int i = 0; i < COLUMN_NODES; ++i) {
    StretchedNode node = stretched_node(path, column_node(i), column_weight(i));
    column += node.width_km * relative_density(altitude_after(h, mu, node.distance_km), c);
  }
  return column;
}

// Of a density that is smooth between two distances which are close for the curvature of the shell.
Real plain_column(Real h, Real mu, Real from_km, Real to_km, int c) {
  Real column = 0.0;
  UNROLL for (int i = 0; i < (COLUMN_NODES == 8 ? 4 : 3); ++i) {
    Real distance_km = from_km + (to_km - from_km) * plain_node(i);
    column += plain_weight(i) * relative_density(altitude_after(h, mu, distance_km), c);
  }
  return column * (to_km - from_km);
}

Real tent_column(Real h, Real mu, Real length_km, int c) {
  MediumData m = medium(c);
  Real half_width = 1.0 / m.b;
  Real low = distance_up_to(m.a - half_width, h, mu, length_km);
  Real centre = distance_up_to(m.a, h, mu, length_km);
  Real high = distance_up_to(m.a + half_width, h, mu, length_km);
  return plain_column(h, mu, low, centre, c) + plain_column(h, mu, centre, high, c);
}

// Between two distances at which a ray passes neighbouring nodes of a table, the lower one given.
Real node_column(Real h, Real mu, Real from_km, Real to_km, Vec4 node) {
  Real column = 0.0;
  UNROLL for (int i = 0; i < 8; ++i) {
    Real distance_km = from_km + (to_km - from_km) * gauss8_node(i);
    Real x = altitude_after(h, mu, distance_km) - node.x;
    column += gauss8_weight(i) * (node.y + node.z * x) * exp(node.w * x);
  }
  return column * (to_km - from_km);
}

Real table_column(Real h, Real mu, Real length_km, int c) {
  MediumData m = medium(c);
  Real column = 0.0;
  Real from_km = 0.0;
  Vec4 node = READ(profile_nodes, m.profile_node);
  for (int i = 1; i <= m.profile_nodes && from_km < length_km; ++i) {
    Vec4 next = READ(profile_nodes, m.profile_node + min(i, m.profile_nodes - 1));
    Real to_km =
        i < m.profile_nodes ? distance_up_to(next.x, h, mu, length_km) : length_km;
    if (to_km > from_km) {
      column += node_column(h, mu, from_km, to_km, node);
      from_km = to_km;
    }
    node = next;
  }
  return column;
}

Real column_upwards(Real h, Real mu, Real length_km, int c) {
  if (c < EXPONENTIALS) return stretched_column(h, mu, length_km, 1.0 / medium(c).a, c);
  if (c < EXPONENTIALS + TENTS) return tent_column(h, mu, length_km, c);
  if (c < EXPONENTIALS + TENTS + QUADRATICS) {
    return stretched_column(h, mu, length_km, scene.thickness_km, c);
  }
  if (c < MEDIA - TABLES) return length_km;
  return table_column(h, mu, length_km, c);
}

// Columns of the constituents [first, end) over the first `length_km` of a ray that stays in the shell;
// 0 for the others.
void some_columns_along(Real h, Real mu, Real length_km, int first, int end,
                        OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] = 0.0;
  Real to_lowest_km = min(max(-(scene.planet_radius_km + h) * mu, 0.0), length_km);
  Real low_h = altitude_after(h, mu, to_lowest_km);
  // Seen from there: back to the start, and on to the end.
  Real back_mu = max(-((scene.planet_radius_km + h) * mu + to_lowest_km) /
                         (scene.planet_radius_km + low_h),
                     0.0);
  Real on_mu = max(mu, 0.0);
  for (int part = to_lowest_km > 0.0 ? 0 : 1; part < 2; ++part) {
    Real part_mu = part == 0 ? back_mu : on_mu;
    Real part_km = part == 0 ? to_lowest_km : length_km - to_lowest_km;
    if (part_km <= 0.0) continue;
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      if (c >= first && c < end) column[c] += column_upwards(low_h, part_mu, part_km, c);
    }
  }
}

// Of all constituents.
void columns_along(Real h, Real mu, Real length_km, OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  some_columns_along(h, mu, length_km, 0, MEDIA, column);
}

void columns_to_top(Real h, Real mu, OUT_ARRAY(Real, column, MEDIA_SIZE)) {
  columns_along(h, mu, distance_to_top(h, mu), column);
}
