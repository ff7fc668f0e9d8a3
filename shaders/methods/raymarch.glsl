// Single scattering by Gauss-Legendre quadrature on each smooth piece of the view ray: it is cut at its
// lowest point, at the edges of the planet's shadow, where no rule converges, at the kinks of scattering
// profiles, and where wavelengths that the air hides end and others go on. Within a piece nodes are
// stretched from its low end (physics/columns.glsl). Columns to the sun have a rule of their own at every
// node; columns to the camera grow from node to node by a three-point rule.

// The share of a constituent's extinction that dims light on its way to the camera: less than 1 for
// methods that take light which a forward peak scatters straight on as not scattered.
#ifndef VIEW_SHARE
#define VIEW_SHARE(c) 1.0
#endif

// The share of the sun that heights of the ground leave to the air at a point. A kernel that knows of heights
// defines it; for others the planet's own shadow is all there is.
#ifndef SUN_OVER_HEIGHTS
#define SUN_OVER_HEIGHTS(position, altitude_km, to_sun) 1.0
#endif

// Optical depths over which the nodes next to a camera in dense air spread, and from which on a wavelength has
// had its nodes.
CONSTANT Real VIEW_DEPTHS = 6.0;
CONSTANT Real UNSEEN_DEPTHS = 2.0 * VIEW_DEPTHS;

// A piece of the path, looked at from its low end upwards; from its near end where so dense air begins
// there that nothing comes from the far one.
struct Piece {
  Real from_km, to_km;   // distances along the path
  bool downwards;        // looked at from the far end
  Real altitude_km, mu;  // at the end that it is looked at from
  Real reach_km;         // from its near end to about VIEW_DEPTHS
};

// The distance from a piece's near end beyond which little light comes back of some wavelength that comes so
// far, by halves of the piece; all of it where no layer hides anything.
Real reach_into(Path path, Real from_km, Real to_km, ARRAY(Real, view_column, MEDIA_SIZE)) {
  Real reach_km = to_km - from_km;
  for (int i = 0; i < 16 * scene.layers; ++i) {
    Real half_km = 0.5 * reach_km;
    Real h = altitude_after(path.altitude_km, path.mu, from_km + half_km);
    if (largest_extinction_behind(view_column, UNSEEN_DEPTHS, h) * half_km < VIEW_DEPTHS) break;
    reach_km = half_km;
  }
  return reach_km;
}

// `view_column`: from the camera to its near end.
Piece piece_between(Path path, Real from_km, Real to_km, ARRAY(Real, view_column, MEDIA_SIZE)) {
  Piece piece;
  Real r = scene.planet_radius_km + path.altitude_km;
  piece.from_km = from_km;
  piece.to_km = to_km;
  piece.downwards = r * path.mu + 0.5 * (from_km + to_km) < 0.0;
  Real low_km = piece.downwards ? to_km : from_km;
  piece.altitude_km = altitude_after(path.altitude_km, path.mu, low_km);
  Real mu = (r * path.mu + low_km) / (scene.planet_radius_km + piece.altitude_km);
  piece.mu = max(piece.downwards ? -mu : mu, 0.0);
  // In a layer that is denser inside than at its edge, as clouds are, little comes from beyond its rim.
  Real length_km = to_km - from_km;
  Real near_h = altitude_after(path.altitude_km, path.mu, from_km);
  Real extinction = largest_extinction_behind(view_column, UNSEEN_DEPTHS, near_h);
  bool dense = extinction * length_km > UNSEEN_DEPTHS;
  piece.reach_km = VIEW_DEPTHS / max(extinction, 1e-9);
  Real reach_km = reach_into(path, from_km, to_km, view_column);
  StretchedPath upwards =
      stretched_path(piece.altitude_km, piece.mu, length_km, scene.view_scale_km);
  if (reach_km < min(length_km, upwards.bend_km)) {
    dense = true;
    piece.reach_km = min(piece.reach_km, reach_km);
  }
  if (piece.downwards && dense) {
    piece.downwards = false;
    piece.altitude_km = near_h;
    piece.mu = (r * path.mu + from_km) / (scene.planet_radius_km + near_h);
  }
  return piece;
}

// The next distance at which the path comes to an altitude, if it does before `end_km`.
Real next_crossing(Path path, Real altitude, Real after_km, Real end_km) {
  Real b = (scene.planet_radius_km + path.altitude_km) * path.mu;
  Real c = (path.altitude_km - altitude) *
           (2.0 * scene.planet_radius_km + path.altitude_km + altitude);
  Real d = b * b - c;
  if (d <= 0.0) return end_km;
  Real root = b > 0.0 ? -b - sqrt(d) : sqrt(d) - b;
  Real low = min(root, c / root);
  Real high = max(root, c / root);
  if (low > after_km) return min(low, end_km);
  return high > after_km ? min(high, end_km) : end_km;
}

Real next_edge(Shadow shadow, Real after_km, Real end_km) {
  if (shadow.enter_km > after_km) return min(shadow.enter_km, end_km);
  return shadow.leave_km > after_km ? min(shadow.leave_km, end_km) : end_km;
}

// Where the piece that begins at a distance ends: at the lowest point, an edge of the shadow, or where
// the path itself or the lowest point of the light on its way to it passes a kink of a profile.
Real end_of_piece(Path path, Light light, Shadow shadow, Real from_km) {
  Real after_km = from_km + 1e-6 * path.length_km;
  Real end_km = next_edge(shadow, after_km, path.length_km);
  Real lowest_km = -(scene.planet_radius_km + path.altitude_km) * path.mu;
  if (lowest_km > after_km) end_km = min(end_km, lowest_km);
  for (int i = 0; i < scene.kinks; ++i) {
    end_km = next_crossing(path, kink_km(i), after_km, end_km);
    end_km = next_edge(shadow_on(path, light, kink_km(i)), after_km, end_km);
  }
  return end_km;
}

// Where the near end is looked at, light from beyond some optical depths doesn't arrive. Under a sun that is
// lower than the view, more light comes from above than the air on the way takes away.
bool is_seen_nearby(Piece piece, Real mu_sun) { return !piece.downwards && piece.mu < mu_sun; }

// Nodes of a piece.
StretchedPath nodes_of(Piece piece, Real mu_sun) {
  Real length_km = piece.to_km - piece.from_km;
  StretchedPath nodes =
      stretched_path(piece.altitude_km, piece.mu, length_km, scene.view_scale_km);
  if (is_seen_nearby(piece, mu_sun)) nodes.bend_km = min(nodes.bend_km, piece.reach_km);
  nodes.end = length_km / sqrt(length_km * length_km + nodes.bend_km * nodes.bend_km);
  return nodes;
}

// Adds the columns between two stretched coordinates of a piece.
void add_columns_between(Piece piece, StretchedPath nodes, Real x_from, Real x_to,
                         INOUT_ARRAY(Real, column, MEDIA_SIZE)) {
  UNROLL for (int i = 0; i < 3; ++i) {
    StretchedNode node = stretched_node(nodes, x_from + (x_to - x_from) * gauss3_node(i),
                                        gauss3_weight(i) * abs(x_to - x_from));
    Real h = altitude_after(piece.altitude_km, piece.mu, node.distance_km);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      column[c] += node.width_km * relative_density(h, c);
    }
  }
}

// Adds what a lit piece scatters towards the camera. `view_column`: from the camera to the piece's near
// end.
void add_lit_piece(Path path, Piece piece, int sun, Real sun_cosine, int view_nodes,
                   ARRAY(Real, view_column, MEDIA_SIZE),
                   INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Real density[MEDIA_SIZE];
  Real column[MEDIA_SIZE];
  Real to_camera[MEDIA_SIZE];
  Vec4 scattering_phase[MEDIA_GROUPS_SIZE];
  UNROLL for (int c = 0; c < MEDIA; ++c) to_camera[c] = view_column[c];
  Vec3 offset = MANY_SUNS ? sun_offset(sun) : Vec3(0.0);
  Vec3 to_sun = sun_ray(path.start, offset).direction;
  scattering_towards(scattering_angle(to_sun, path.direction), scattering_phase);
  StretchedPath nodes = nodes_of(piece, sun_cosine);
  Real last_x = piece.downwards ? 1.0 : 0.0;
  for (int i = 0; i < view_nodes; ++i) {
    int k = piece.downwards ? view_nodes - 1 - i : i;
    Vec2 rule = gauss_node(view_nodes, k);
    Real x = rule.x;
    StretchedNode node = stretched_node(nodes, x, rule.y);
    add_columns_between(piece, nodes, last_x, x, to_camera);
    last_x = x;
    Real h = altitude_after(piece.altitude_km, piece.mu, node.distance_km);
    Real t = piece.downwards ? piece.to_km - node.distance_km : piece.from_km + node.distance_km;
    Vec3 position = path.start + path.direction * t;
    SunRay ray = sun_ray(position, offset);
    Real mu_sun = dot(position, ray.direction) / length(position);
    // Next to the shadow's edge a node may fall into the ground by rounding.
    mu_sun = max(mu_sun, horizon_cosine(h));
    densities(h, density);
    columns_to_top(h, mu_sun, column);
    if (NEAR_SUN) {
      scattering_towards(scattering_angle(ray.direction, path.direction), scattering_phase);
    }
    UNROLL for (int c = 0; c < MEDIA; ++c) column[c] += VIEW_SHARE(c) * to_camera[c];
    Real light = ray.irradiance * SUN_OVER_HEIGHTS(position, h, ray.direction);
    add_scattered(column, density, scattering_phase, node.width_km * light, sun, inscatter);
  }
}

// Pieces of a path at the most: a dozen kinks are passed twice by the path and twice by its light.
CONSTANT int MOST_PIECES = 64;

// Adds the light of the sun's point `sun` that is scattered once along the path, from `from_km` on
// for a number of pieces.
void march_towards(Path path, int sun, int view_nodes, int pieces, INOUT(Real) from_km,
                   INOUT_ARRAY(Vec4, inscatter, GROUPS_SIZE)) {
  Light light = light_of_sun(sun);
  Shadow shadow = shadow_on(path, light, 0.0);
  Vec3 to_sun = sun_ray(path.start, MANY_SUNS ? sun_offset(sun) : Vec3(0.0)).direction;
  Real sun_cosine = dot(path.start, to_sun) / length(path.start);
  Real view_column[MEDIA_SIZE];
  for (int i = 0; i < pieces && from_km < path.length_km; ++i) {
    Real to_km = end_of_piece(path, light, shadow, from_km);
    Real middle_km = 0.5 * (from_km + to_km);
    if (middle_km <= shadow.enter_km || middle_km >= shadow.leave_km) {
      columns_along(path.altitude_km, path.mu, from_km, view_column);
      Piece piece = piece_between(path, from_km, to_km, view_column);
      // Wavelengths that see much farther than the one for which the nodes are have a piece of their own.
      Real seen_km = max(UNSEEN_DEPTHS / VIEW_DEPTHS * piece.reach_km, 1e-6 * path.length_km);
      if (is_seen_nearby(piece, sun_cosine) && seen_km < to_km - from_km) {
        to_km = from_km + seen_km;
        piece.to_km = to_km;
      }
      add_lit_piece(path, piece, sun, sun_cosine, view_nodes, view_column, inscatter);
    }
    from_km = to_km;
  }
}

// Adds the radiance of the ground at the end of a path that meets it under the sun's point `sun`, before
// the air in front of it.
void light_ground_from(Path path, int sun, INOUT_ARRAY(Vec4, ground, GROUPS_SIZE)) {
  if (!path.meets_ground) return;
  Vec3 position = path.start + path.direction * path.length_km;
  SunRay ray = sun_ray(position, MANY_SUNS ? sun_offset(sun) : Vec3(0.0));
  Real mu_sun = dot(position, ray.direction) / length(position);
  if (mu_sun <= 0.0) return;
  Real column[MEDIA_SIZE];
  columns_to_top(0.0, mu_sun, column);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 light = transmittance_of(column, group) * (ray.irradiance * mu_sun);
    if (MANY_SUNS) light = light * sun_weight(sun, group);
    ground[group] = ground[group] + lambertian(group) * light;
  }
}
