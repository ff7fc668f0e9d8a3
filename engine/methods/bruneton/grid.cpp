#include "engine/methods/bruneton/grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/gauss_legendre.h"

namespace cyanometer::bruneton {
namespace {

using P = Physics<double>;

/// The angle by which the horizon is lower at the top than on the ground: how far below the
/// ground's horizon the sun still lights some air overhead.
double dip_of_top(const Problem& problem) {
  return std::acos(problem.planet_radius_km /
                   (problem.planet_radius_km + problem.thickness_km));
}

/// The suns' mapping from the geometry of the planet's shadow: nodes are densest at a third of
/// the dip below the horizon, where the shadow passes through the thick of the air, and half
/// the dip about it. The first node lies two and a half dips below, where only light of the
/// third order arrives.
void set_suns(P::ScatteringGrid& grid, const Problem& problem) {
  double dip = dip_of_top(problem);
  double lowest = std::sin(std::min(2.5 * dip, std::numbers::pi / 2));
  grid.lowest_sun = -lowest;
  grid.sun_shift = std::sin(0.3 * dip);
  grid.sun_width = std::sin(0.5 * dip);
  grid.sun_first = std::asinh((grid.sun_shift - lowest) / grid.sun_width);
  grid.sun_span = std::asinh((grid.sun_shift + 1) / grid.sun_width) - grid.sun_first;
}

P::ScatteringGrid grid_of(const Problem& problem, const Setup& setup) {
  P::ScatteringGrid grid{};
  grid.altitudes = setup.altitudes;
  grid.zeniths = setup.zeniths;
  grid.suns = setup.suns;
  grid.azimuths = setup.azimuths;
  grid.mapping = setup.mapping;
  grid.two_sided = setup.two_sided;
  grid.highest_mu = 1;
  set_suns(grid, problem);
  return grid;
}

ScatteringGrid in_float(const P::ScatteringGrid& grid) {
  auto f = [](double x) { return static_cast<float>(x); };
  return {grid.altitudes,    grid.zeniths,      grid.suns,          grid.azimuths,
          grid.mapping,      grid.two_sided,    f(grid.highest_mu), f(grid.lowest_sun),
          f(grid.sun_shift), f(grid.sun_width), f(grid.sun_first),  f(grid.sun_span)};
}

/// Value at x of the polynomial through the nodes first ... first + degree that is 1 at `node`
/// and 0 at the others.
double cardinal(int node, int first, int degree, double x) {
  double value = 1;
  for (int other = first; other <= first + degree; ++other) {
    if (other != node) value *= (x - other) / (node - other);
  }
  return value;
}

/// Weights of an integral over mu(0) ... mu(nodes - 1), of what is interpolated between nodes
/// by polynomials of a degree through those about each interval.
std::vector<double> interpolatory_weights(int nodes, int degree,
                                          const std::function<double(double)>& mu) {
  static const GaussRule rule = gauss_legendre(6);
  constexpr double step = 1e-5;
  std::vector<double> weights(nodes, 0.0);
  for (int interval = 0; interval + 1 < nodes; ++interval) {
    int first = std::clamp(interval - (degree - 1) / 2, 0, nodes - 1 - degree);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      double x = interval + rule.nodes[k];
      double slope = (mu(x + step) - mu(x - step)) / (2 * step);
      for (int node = first; node <= first + degree; ++node) {
        weights[node] += rule.weights[k] * slope * cardinal(node, first, degree, x);
      }
    }
  }
  return weights;
}

/// Of the zenith nodes at one altitude; each side of the horizon by itself.
std::vector<double> zenith_weights(P& p, const P::ScatteringGrid& grid, double h, int degree) {
  int sides = grid.two_sided ? 2 : 1, nodes = grid.zeniths / sides;
  std::vector<double> weights;
  for (int side = 0; side < sides; ++side) {
    auto mu = [&](double x) { return p.zenith_cosine(grid, h, side * nodes + x); };
    std::vector<double> of_side = interpolatory_weights(nodes, std::min(degree, nodes - 1), mu);
    weights.insert(weights.end(), of_side.begin(), of_side.end());
  }
  return weights;
}

Rays rays_at(P& p, const P::ScatteringGrid& grid, const std::vector<double>& altitudes,
             const std::vector<double>& suns, int degree) {
  Rays rays{in_float(grid), {}};
  auto append = [&](double x) { rays.nodes.push_back(static_cast<float>(x)); };
  std::vector<double> weights;
  std::ranges::for_each(altitudes, append);
  std::ranges::for_each(suns, append);
  for (double h : altitudes) {
    for (int z = 0; z < grid.zeniths; ++z) append(p.zenith_cosine(grid, h, z));
    std::vector<double> here = zenith_weights(p, grid, h, degree);
    weights.insert(weights.end(), here.begin(), here.end());
  }
  std::ranges::for_each(weights, append);
  return rays;
}

std::vector<double> all_altitudes(P& p, const P::ScatteringGrid& grid) {
  std::vector<double> altitudes;
  for (int a = 0; a < grid.altitudes; ++a) {
    altitudes.push_back(p.altitude_at(grid, static_cast<double>(a) / (grid.altitudes - 1)));
  }
  return altitudes;
}

std::vector<double> all_suns(P& p, const P::ScatteringGrid& grid) {
  std::vector<double> suns;
  for (int s = 0; s < grid.suns; ++s) {
    suns.push_back(p.sun_cosine_at(grid, static_cast<double>(s) / (grid.suns - 1)));
  }
  return suns;
}

/// A table for one camera is cheap, so that its directions can be dense.
void refine_directions(P::ScatteringGrid& grid, int zeniths, int azimuths) {
  grid.zeniths = std::max(grid.zeniths, zeniths);
  grid.azimuths = std::max(grid.azimuths, azimuths);
}

P::ScatteringGrid refined_source_grid(const Problem& problem, const Setup& setup) {
  P::ScatteringGrid grid = grid_of(problem, setup);
  grid.altitudes = setup.refined(grid.altitudes);
  grid.suns = setup.refined(grid.suns);
  grid.zeniths = setup.refined(setup.source_zeniths);
  grid.azimuths = setup.refined(setup.source_azimuths);
  return grid;
}

int degree_of(const Setup& setup) { return setup.refinement > 1 ? 3 : 1; }

}  // namespace

Setup::Setup(const MethodOptions& options) {
  auto option = [&](const char* name) { return static_cast<int>(options.at(name)); };
  orders = option("orders");
  altitudes = option("altitudes");
  zeniths = 2 * option("zeniths");
  suns = option("suns");
  azimuths = option("azimuths");
  source_zeniths = option("source_zeniths");
  source_azimuths = option("source_azimuths");
  refinement = option("refinement");
  cells = option("samples");
  view_cells = option("view_samples");
  view_nodes = option("view_nodes");
  mapping = option("mapping");
  two_sided = option("horizon") != 0;
  logarithmic = option("logarithmic") != 0;
  gathered_view = option("gather") != 0;
  first = static_cast<First>(option("first_order"));
}

std::string Setup::key() const {
  std::string text;
  for (int value : {orders, altitudes, zeniths, suns, azimuths, source_zeniths, source_azimuths,
                    refinement, cells, view_nodes, mapping, int{two_sided}, int{logarithmic},
                    static_cast<int>(first)}) {
    text += std::to_string(value) + " ";
  }
  return text;
}

Rays all_rays(const Problem& problem, const Setup& setup) {
  P p = pack<double>(problem);
  P::ScatteringGrid grid = grid_of(problem, setup);
  return rays_at(p, grid, all_altitudes(p, grid), all_suns(p, grid), degree_of(setup));
}

Rays rays_from(const Problem& problem, const Setup& setup, double altitude_km, double mu_s) {
  P p = pack<double>(problem);
  P::ScatteringGrid grid = grid_of(problem, setup);
  refine_directions(grid, 128, 33);
  grid.altitudes = 1;
  grid.suns = 1;
  return rays_at(p, grid, {altitude_km}, {mu_s}, degree_of(setup));
}

Rays rays_from_space(const Problem& problem, const Setup& setup) {
  P p = pack<double>(problem);
  P::ScatteringGrid grid = grid_of(problem, setup);
  refine_directions(grid, 96, 25);
  grid.altitudes = 1;
  grid.suns = 2 * grid.suns;
  grid.highest_mu = 0;
  return rays_at(p, grid, {problem.thickness_km}, all_suns(p, grid), degree_of(setup));
}

ScatteringGrid source_grid(const Problem& problem, const Setup& setup) {
  return in_float(refined_source_grid(problem, setup));
}

Places source_places(const Problem& problem, const Setup& setup) {
  P p = pack<double>(problem);
  P::ScatteringGrid grid = refined_source_grid(problem, setup);
  return {all_altitudes(p, grid), all_suns(p, grid)};
}

}  // namespace cyanometer::bruneton
