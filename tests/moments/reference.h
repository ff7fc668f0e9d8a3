// The moment method in double on the processor: the formulas of shaders/methods/moments.glsl
// with plain loops, none of the device's short cuts (no finer tables read linearly, no forward
// peak, no damped series), and as many moments, nodes and orders as one likes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/gauss_legendre.h"
#include "engine/methods/moments/grid.h"
#include "engine/methods/moments/phase_series.h"
#include "engine/physics/pack.h"

namespace cyanometer {

struct ReferenceSizes {
  int degree = 6, altitudes = 12, suns = 24, up = 12, down = 8, azimuths = 10, steps = 10,
      first_steps = 12, orders = 5, view_steps = 32;
  bool tail = true;
};

/// One group of wavelengths.
class MomentReference {
 public:
  using P = Physics<double>;
  using Value = glm::dvec4;

  MomentReference(const Problem& problem, const ReferenceSizes& sizes)
      : p_(pack<double>(problem)),
        size_(sizes),
        first_rule_(gauss_legendre(sizes.first_steps)),
        grid_(moment_grid<double>(problem, sizes.altitudes, sizes.suns)) {
    for (const Medium* medium : packed_media(problem)) {
      auto& chi = chi_.emplace_back(P::MOST_TERMS, Value(0));
      bool scatters = std::ranges::max(medium->scattering_per_km) > 0;
      auto all = legendre_coefficients(medium->phase, problem.wavelengths_nm.size(),
                                       P::MOST_TERMS - 1);
      for (int w = 0; scatters && w < static_cast<int>(problem.wavelengths_nm.size()); ++w) {
        for (int l = 0; l < P::MOST_TERMS; ++l) chi[l][w] = all[w][l];
      }
    }
    for (int i = 0; i < size_.altitudes; ++i) add_rays(i);
    solve();
  }

  /// What is scattered or reflected more than once, towards a camera of the same air.
  /// @param end_km  where something stands that hides the ground behind it
  Value further_radiance(const Problem& view, const glm::dvec3& direction,
                         double end_km = std::numeric_limits<double>::infinity()) {
    p_.scene = pack<double>(view).scene;
    P::Path path = p_.path_from_camera(direction);
    if (!p_.meets_planet(path)) return Value(0);
    bool cut = std::isfinite(end_km);
    Ray ray = traced(path.altitude_km, path.mu, std::min(path.length_km, end_km),
                     path.meets_ground && !cut, size_.view_steps);
    glm::dvec3 axis = p_.sun_axis();
    double mu_s = glm::dot(path.start, axis) / glm::length(path.start);
    return next_order(ray, mu_s, glm::dot(axis, direction), sum_);
  }

 private:
  struct Node {
    double t_km, altitude_km, mu, width_km;
    std::array<double, P::MEDIA_SIZE> density;
    Value seen;  ///< transmittance to the ray's start
  };
  struct Ray {
    double altitude_km, mu, weight, length_km;
    bool meets_ground;
    std::vector<Node> nodes;
    Value reflected;  ///< ground radiance per unit irradiance, as seen from the ray's start
  };
  /// Moments by altitude and sun, and the ground's irradiance by sun.
  struct Table {
    std::vector<std::vector<Value>> moments;
    std::vector<Value> irradiance;
  };

  int moments() const { return (size_.degree + 1) * (size_.degree + 2) / 2; }
  int at(int i, int s) const { return i * size_.suns + s; }
  Table empty() const {
    return {std::vector(size_.altitudes * size_.suns, std::vector(moments(), Value(0))),
            std::vector(size_.suns, Value(0))};
  }
  double sun(double altitude_km, int s) {
    return p_.sun_of_node(grid_, p_.sun_range(grid_, altitude_km), s);
  }

  Value transmittance(const double (&column)[P::MEDIA_SIZE]) {
    return p_.transmittance_of(column, 0);
  }

  Ray traced(double h, double mu, double length_km, bool meets_ground, int steps) {
    Ray ray{h, mu, 0, length_km, meets_ground, {}, Value(0)};
    GaussRule rule = gauss_legendre(steps);
    P::Cuts cuts = p_.cuts_of(h, mu, length_km);
    double column[P::MEDIA_SIZE], density[P::MEDIA_SIZE];
    for (int k = 0; k < steps; ++k) {
      P::RayNode place = p_.ray_node(cuts, rule.nodes[k], rule.weights[k]);
      Node node{place.t_km, p_.altitude_after(h, mu, place.t_km), 0, place.width_km, {}, {}};
      node.mu = p_.mu_after(h, mu, place.t_km, node.altitude_km);
      p_.densities(node.altitude_km, density);
      p_.columns_along(h, mu, place.t_km, column);
      std::copy(density, density + p_.MEDIA, node.density.begin());
      node.seen = transmittance(column);
      ray.nodes.push_back(node);
    }
    p_.columns_along(h, mu, length_km, column);
    if (meets_ground) ray.reflected = p_.lambertian(0) * transmittance(column);
    return ray;
  }

  void add_rays(int i) {
    double h = p_.altitude_of_node(grid_, i);
    auto& rays = rays_.emplace_back();
    for (bool down : {false, true}) {
      GaussRule rule = gauss_legendre(down ? size_.down : size_.up);
      for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
        P::ZenithNode node = p_.zenith_node(h, down, rule.nodes[j], rule.weights[j]);
        double length =
            down ? p_.distance_to_ground(h, node.mu) : p_.distance_to_top(h, node.mu);
        rays.push_back(traced(h, node.mu, length, down, size_.steps));
        rays.back().weight = node.weight;
      }
    }
  }

  /// Order one and the sunlit ground, along a ray cut at the planet's shadow.
  Value first_order(const Ray& ray, const glm::dvec3& direction, const glm::dvec3& axis) {
    P::Path path;
    path.start = {0, 0, p_.scene.planet_radius_km + ray.altitude_km};
    path.direction = direction;
    path.altitude_km = ray.altitude_km;
    path.mu = ray.mu;
    path.length_km = ray.length_km;
    path.meets_ground = ray.meets_ground;
    p_.scene.sun_direction = {axis, 0};
    p_.scene.sun_position = {axis * p_.scene.sun_distance_km, 0};
    P::Shadow shadow = p_.shadow_on(path, p_.light_of_sun(0), 0.0);
    bool dark = shadow.leave_km > shadow.enter_km;
    Value light = lit_part(path, 0, dark ? shadow.enter_km : path.length_km);
    if (dark) light += lit_part(path, shadow.leave_km, path.length_km);
    if (ray.meets_ground) {
      glm::dvec3 x = path.start + direction * path.length_km;
      P::SunRay sun = p_.sun_ray(x, glm::dvec3(0));
      double mu_sun = glm::dot(x, sun.direction) / glm::length(x);
      double column[P::MEDIA_SIZE];
      if (mu_sun > 0) {
        p_.columns_to_top(0, mu_sun, column);
        light += ray.reflected * transmittance(column) * (mu_sun * sun.irradiance);
      }
    }
    return light;
  }

  Value lit_part(const P::Path& path, double from_km, double to_km) {
    if (to_km - from_km <= 1e-9 * path.length_km) return Value(0);
    P::Cuts cuts =
        p_.part_of(p_.cuts_of(path.altitude_km, path.mu, path.length_km), from_km, to_km);
    Value light(0);
    double view[P::MEDIA_SIZE], column[P::MEDIA_SIZE], density[P::MEDIA_SIZE];
    glm::dvec4 phase[P::MEDIA_GROUPS_SIZE], inscatter[P::GROUPS_SIZE] = {};
    for (std::size_t k = 0; k < first_rule_.nodes.size(); ++k) {
      P::RayNode node = p_.ray_node(cuts, first_rule_.nodes[k], first_rule_.weights[k]);
      double h = p_.altitude_after(path.altitude_km, path.mu, node.t_km);
      glm::dvec3 x = path.start + path.direction * node.t_km;
      P::SunRay sun = p_.sun_ray(x, glm::dvec3(0));
      double mu_sun =
          std::max(glm::dot(x, sun.direction) / glm::length(x), p_.horizon_cosine(h));
      p_.columns_along(path.altitude_km, path.mu, node.t_km, view);
      p_.columns_to_top(h, mu_sun, column);
      p_.densities(h, density);
      for (int c = 0; c < p_.MEDIA; ++c) column[c] += view[c];
      p_.scattering_towards(p_.scattering_angle(sun.direction, path.direction), phase);
      p_.add_scattered(column, density, phase, node.width_km * sun.irradiance, 0, inscatter);
    }
    return inscatter[0];
  }

  /// The orders that follow from those of a table.
  Value next_order(const Ray& ray, double mu_s, double nu, const Table& table) {
    Value light(0);
    for (const Node& node : ray.nodes) {
      double here = p_.axis_after(ray.altitude_km, mu_s, nu, node.t_km, node.altitude_km);
      light += source(node, here, nu, table) * node.seen * node.width_km;
    }
    if (ray.meets_ground) {
      double here = p_.axis_after(ray.altitude_km, mu_s, nu, ray.length_km, 0);
      light += ray.reflected * irradiance(here, table);
    }
    return light;
  }

  Value source(const Node& node, double mu_s, double nu, const Table& table) {
    P::CubicTaps altitudes =
        p_.cubic_taps(p_.node_of_altitude(grid_, node.altitude_km), size_.altitudes);
    P::CubicTaps suns = p_.cubic_taps(
        p_.node_of_sun(grid_, p_.sun_range(grid_, node.altitude_km), mu_s), size_.suns);
    double p[P::MOST_MOMENTS], c[P::MOST_DEGREE + 1];
    p_.zenith_polynomials(node.mu, size_.degree, p);
    p_.azimuth_terms(node.mu, mu_s, nu, size_.degree, c);
    std::vector<Value> series = scattered_series(node);
    Value logarithm(0), ratio(0);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        double weight = altitudes.weights[a] * suns.weights[b];
        const auto& moment = table.moments[at(altitudes.first + a, suns.first + b)];
        Value sum(0);
        for (int l = 0; l <= size_.degree; ++l) {
          for (int m = 0; m <= l; ++m) {
            int n = p_.moment_index(l, m);
            sum += series[l] * p_.moment_ratio(moment[n], moment[0]) * (p[n] * c[m]);
          }
        }
        ratio += weight * sum;
        logarithm += weight * p_.moment_logarithm(moment[0]);
      }
    }
    return ratio * glm::exp(glm::min(logarithm, Value(0)));
  }

  std::vector<Value> scattered_series(const Node& node) {
    std::vector<Value> series(size_.degree + 1, Value(0));
    for (int c = 0; c < p_.MEDIA; ++c) {
      for (int l = 0; l <= size_.degree; ++l) {
        series[l] += p_.scattering(c, 0) * node.density[c] * chi_[c][l];
      }
    }
    return series;
  }

  Value irradiance(double mu_s, const Table& table) {
    P::CubicTaps taps =
        p_.cubic_taps(p_.node_of_sun(grid_, p_.sun_range(grid_, 0), mu_s), size_.suns);
    Value sum(0);
    for (int b = 0; b < 4; ++b) {
      sum += taps.weights[b] * p_.moment_logarithm(table.irradiance[taps.first + b]);
    }
    return glm::exp(sum);
  }

  /// Moments of what `light(ray, mu_s, nu, direction, axis)` brings from all directions.
  template <class Light>
  Table gathered(const Light& light) {
    Table table = empty();
    for (int i = 0; i < size_.altitudes; ++i) {
      for (int s = 0; s < size_.suns; ++s) {
        for (const Ray& ray : rays_[i]) gather(i, s, ray, light, table);
      }
    }
    return table;
  }

  template <class Light>
  void gather(int i, int s, const Ray& ray, const Light& light, Table& table) {
    double mu_s = sun(ray.altitude_km, s), sin_s = std::sqrt(1 - mu_s * mu_s);
    double p[P::MOST_MOMENTS], c[P::MOST_DEGREE + 1];
    p_.zenith_polynomials(ray.mu, size_.degree, p);
    glm::dvec3 axis(sin_s, 0, mu_s);
    for (int a = 0; a < size_.azimuths; ++a) {
      double azimuth = std::numbers::pi * (a + 0.5) / size_.azimuths;
      double sine = std::sqrt(1 - ray.mu * ray.mu);
      glm::dvec3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), ray.mu);
      double nu = glm::dot(axis, direction);
      Value radiance = light(ray, mu_s, nu, direction, axis);
      double weight = ray.weight * 2 * std::numbers::pi / size_.azimuths;
      p_.azimuth_terms(ray.mu, mu_s, nu, size_.degree, c);
      for (int l = 0; l <= size_.degree; ++l) {
        for (int m = 0; m <= l; ++m) {
          int n = p_.moment_index(l, m);
          table.moments[at(i, s)][n] +=
              radiance *
              (weight * p[n] * c[m] * p_.harmonic_norm(l, m) / std::pow(sin_s * sin_s, m));
        }
      }
      if (i == 0 && ray.mu > 0) table.irradiance[s] += radiance * (weight * ray.mu);
    }
  }

  void solve() {
    Table order =
        gathered([&](const Ray& ray, double, double, const glm::dvec3& direction,
                     const glm::dvec3& axis) { return first_order(ray, direction, axis); });
    sum_ = order;
    Table before = order;
    for (int n = 2; n <= size_.orders; ++n) {
      before = order;
      order = gathered([&](const Ray& ray, double mu_s, double nu, const glm::dvec3&,
                           const glm::dvec3&) { return next_order(ray, mu_s, nu, before); });
      for (std::size_t k = 0; k < order.moments.size(); ++k) add(order.moments[k], Value(1), k);
      for (int s = 0; s < size_.suns; ++s) sum_.irradiance[s] += order.irradiance[s];
    }
    if (size_.tail) close(before, order);
  }

  void add(const std::vector<Value>& moment, const Value& share, std::size_t k) {
    for (int n = 0; n < moments(); ++n) sum_.moments[k][n] += share * moment[n];
  }

  void close(const Table& before, const Table& last) {
    auto further = [](const Value& x, const Value& y) {
      Value ratio = glm::clamp(y / glm::max(x, Value(P::DARKEST)), 0.0, 0.9);
      return ratio / (1.0 - ratio);
    };
    for (std::size_t k = 0; k < last.moments.size(); ++k) {
      add(last.moments[k], further(before.moments[k][0], last.moments[k][0]), k);
    }
    for (int s = 0; s < size_.suns; ++s) {
      sum_.irradiance[s] +=
          last.irradiance[s] * further(before.irradiance[s], last.irradiance[s]);
    }
  }

  P p_;
  ReferenceSizes size_;
  GaussRule first_rule_;
  P::MomentGrid grid_;
  std::vector<std::vector<Value>> chi_;
  std::vector<std::vector<Ray>> rays_;
  Table sum_;
};

}  // namespace cyanometer
