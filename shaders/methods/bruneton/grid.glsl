// Where the tables have their nodes: altitude, zenith cosine of the view, cosine of the sun's zenith
// angle, azimuth between the two. Each mapping takes a quantity to a coordinate from 0 (first node) to
// n - 1 (last); its inverse gives the nodes.
//
// All but the linear mapping gather nodes where light changes fast: near the ground, about the horizon
// and about the terminator. The last angle is the azimuth and not, as in the paper, the cosine between
// view and sun: of that one only a part can be reached, and the nodes of an azimuth are those of the
// rectangle rule, which integrates periodic functions best.

CONSTANT int MAPPING_LINEAR = 0;
CONSTANT int MAPPING_DISTANCES = 1;  // [Bruneton 2017, section "Precomputation"]
CONSTANT int MAPPING_GATHERED = 2;

// All members are 4 bytes, so that std430 and C++ agree.
struct ScatteringGrid {
  int altitudes;
  int zeniths;        // even; with two sides the lower half looks below the horizon
  int suns;
  int azimuths;       // from 0, towards the sun, to pi
  int mapping;
  int two_sided;      // at the horizon: nothing is interpolated across it
  Real highest_mu;    // of a view: 1, or 0 for rays that come in through the top
  Real lowest_sun;    // the sun's zenith cosine at the first node, -1 or more
  Real sun_shift;     // of the gathered mapping: asinh((cosine + shift) / width)
  Real sun_width;
  Real sun_first;     // its values at the first node, and from there to the last
  Real sun_span;
};

// Share of the way between the first node and the last, to a coordinate.
Real node_coordinate(Real share, int nodes) { return clamp(share, 0.0, 1.0) * Real(nodes - 1); }

// --- Altitude: the distance to the horizon, or linear --------------------------------------------

Real altitude_share(ScatteringGrid grid, Real h) {
  if (grid.mapping == MAPPING_LINEAR) return h / scene.thickness_km;
  return sqrt(squared_height(h) / squared_height(scene.thickness_km));
}

Real altitude_at(ScatteringGrid grid, Real share) {
  if (grid.mapping == MAPPING_LINEAR) return share * scene.thickness_km;
  Real radius = scene.planet_radius_km;
  Real squared = share * share * squared_height(scene.thickness_km);
  return min(squared / (sqrt(radius * radius + squared) + radius), scene.thickness_km);
}

// --- Zenith cosine of the view: on each side of the horizon, from it to the pole -------------------

struct HorizonSide {
  Real horizon;  // zenith cosines of both ends
  Real pole;
  Real far_km;   // lengths of the path, to the ground or to the top, at both ends
  Real near_km;
};

HorizonSide horizon_side(ScatteringGrid grid, Real h, bool below) {
  HorizonSide side;
  side.horizon = horizon_cosine(h);
  side.pole = below ? -1.0 : grid.highest_mu;
  side.far_km = below ? sqrt(squared_height(h)) : distance_to_top(h, side.horizon);
  side.near_km = below ? h : distance_to_top(h, side.pole);
  return side;
}

// Lengths of the path say nothing on the ground, looking down: all are 0.
bool by_distance(ScatteringGrid grid, HorizonSide side) {
  return grid.mapping == MAPPING_DISTANCES && side.far_km > side.near_km;
}

// 0 at the horizon, 1 at the pole.
Real side_share(ScatteringGrid grid, Real h, Real mu, bool below) {
  HorizonSide side = horizon_side(grid, h, below);
  if (by_distance(grid, side)) {
    Real length_km = below ? distance_to_ground(h, mu) : distance_to_top(h, mu);
    return clamp((side.far_km - length_km) / (side.far_km - side.near_km), 0.0, 1.0);
  }
  Real share = clamp((mu - side.horizon) / (side.pole - side.horizon), 0.0, 1.0);
  return grid.mapping == MAPPING_GATHERED ? sqrt(share) : share;
}

Real side_cosine(ScatteringGrid grid, Real h, Real share, bool below) {
  HorizonSide side = horizon_side(grid, h, below);
  if (by_distance(grid, side)) {
    Real d = mix(side.far_km, side.near_km, share);
    Real end = below ? 0.0 : scene.thickness_km;
    Real difference =
        (end - h) * (2.0 * scene.planet_radius_km + end + h);  // of the squared radii
    Real mu = (difference - d * d) / (2.0 * (scene.planet_radius_km + h) * d);
    return d > 0.0 ? clamp(mu, -1.0, 1.0) : side.pole;
  }
  if (grid.mapping == MAPPING_GATHERED) share = share * share;
  return mix(side.horizon, side.pole, share);
}

Real zenith_coordinate(ScatteringGrid grid, Real h, Real mu, bool below) {
  if (grid.two_sided == 0 && grid.mapping == MAPPING_LINEAR) {
    return node_coordinate((mu + 1.0) / (grid.highest_mu + 1.0), grid.zeniths);
  }
  Real share = side_share(grid, h, mu, below);
  if (grid.two_sided == 0) {
    return node_coordinate(0.5 + (below ? -0.5 : 0.5) * share, grid.zeniths);
  }
  int half_nodes = grid.zeniths / 2;
  return below ? node_coordinate(1.0 - share, half_nodes)
               : Real(half_nodes) + node_coordinate(share, half_nodes);
}

// Of a node, or between two.
Real zenith_cosine(ScatteringGrid grid, Real h, Real coordinate) {
  if (grid.two_sided == 0) {
    Real share = coordinate / Real(grid.zeniths - 1);
    if (grid.mapping == MAPPING_LINEAR) return mix(-1.0, grid.highest_mu, share);
    return side_cosine(grid, h, abs(2.0 * share - 1.0), share < 0.5);
  }
  Real half_nodes = Real(grid.zeniths / 2);
  bool below = coordinate < half_nodes - 0.5;
  Real share = (below ? coordinate : coordinate - half_nodes) / (half_nodes - 1.0);
  return side_cosine(grid, h, below ? 1.0 - share : share, below);
}

// Whether the view of a node comes to the ground: on the horizon itself there is a node of each side.
bool node_meets_ground(ScatteringGrid grid, Real h, int zenith, Real mu) {
  return grid.two_sided == 0 ? meets_ground(h, mu) : zenith < grid.zeniths / 2;
}

// --- The sun's zenith cosine ----------------------------------------------------------------------

// [Bruneton 2017]: the distance to the top along the light, from the ground as if it were not there.
Real light_distance_share(Real mu_s) {
  Real far_km = sqrt(squared_height(scene.thickness_km));
  return (distance_to_top(0.0, mu_s) - scene.thickness_km) / (far_km - scene.thickness_km);
}

Real sun_share(ScatteringGrid grid, Real mu_s) {
  if (grid.mapping == MAPPING_LINEAR) {
    return (mu_s - grid.lowest_sun) / (1.0 - grid.lowest_sun);
  }
  if (grid.mapping == MAPPING_DISTANCES) {
    Real a = light_distance_share(mu_s);
    return max(1.0 - a / light_distance_share(grid.lowest_sun), 0.0) / (1.0 + a);
  }
  return (inverse_sinh((mu_s + grid.sun_shift) / grid.sun_width) - grid.sun_first) /
         grid.sun_span;
}

Real sun_cosine_at(ScatteringGrid grid, Real share) {
  if (grid.mapping == MAPPING_LINEAR) return mix(grid.lowest_sun, 1.0, share);
  if (grid.mapping == MAPPING_DISTANCES) {
    Real most = light_distance_share(grid.lowest_sun);
    Real far_km = sqrt(squared_height(scene.thickness_km));
    Real d = mix(scene.thickness_km, far_km, most * (1.0 - share) / (1.0 + most * share));
    Real mu_s = (far_km - d) * (far_km + d) / (2.0 * scene.planet_radius_km * d);
    return clamp(mu_s, -1.0, 1.0);
  }
  Real e = exp(grid.sun_first + grid.sun_span * share);
  return clamp(0.5 * (e - 1.0 / e) * grid.sun_width - grid.sun_shift, -1.0, 1.0);
}

// --- Along a ray ------------------------------------------------------------------------------------

// Cosine of the azimuth between a view and the sun, of which zenith cosines and the cosine between the
// two are known; at the poles, where there is no azimuth, any.
Real azimuth_cosine(Real mu, Real sine, Real mu_s, Real nu) {
  Real sun_sine = sqrt(max(1.0 - mu_s * mu_s, 0.0));
  return clamp((nu - mu * mu_s) / max(sine * sun_sine, 1e-9), -1.0, 1.0);
}
