// Single scattering by adaptive quadrature in double: the physics of shaders/physics/ with
// every integral taken to a stated tolerance, the path split where the integrand bends or
// jumps. It shares the formulas with the device, and none of the sampling.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/gauss_legendre.h"
#include "engine/physics/pack.h"

namespace cyanometer::oracle {

using P = Physics<double>;
using Values = std::vector<double>;  ///< by wavelength

/// What one ray shows, per unit irradiance, 1/sr; parallel light from a point.
struct Ray {
  Values inscatter, ground, transmittance;
  Values shadow_edge = {};  ///< a km, the jumps of inscatter's integrand at the planet's shadow
};

class Adaptive {
 public:
  explicit Adaptive(P physics, double tolerance = 1e-7)
      : p_(std::move(physics)), tolerance_(tolerance) {
    altitudes_ = bends();
  }

  /// @param end_km  where the ray ends if not before, on the ground or at the top
  Ray trace(const glm::dvec3& direction,
            double end_km = std::numeric_limits<double>::infinity()) {
    P::Path path = p_.path_from_camera(direction);
    if (end_km < path.length_km) {
      path.length_km = end_km;
      path.meets_ground = false;
    }
    path_ = path;
    Ray ray{Values(lanes(), 0.0), Values(lanes(), 0.0), Values(lanes(), 1.0),
            Values(lanes(), 0.0)};
    if (!p_.meets_planet(path)) return ray;
    sun_ = p_.sun_ray(path.start, glm::dvec3(0)).direction;
    p_.scattering_towards(p_.scattering_angle(sun_, direction), scattering_phase_);
    std::vector<double> pieces = view_pieces();
    bool before = true, now = true;
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i, before = now) {
      now = lit(0.5 * (pieces[i] + pieces[i + 1]));
      if (i > 0 && now != before) add(ray.shadow_edge, source(pieces[i]));
      if (!now) continue;
      add(ray.inscatter, adapt(pieces[i], pieces[i + 1], gauss(pieces[i], pieces[i + 1]), 0));
    }
    Columns columns = column(path.altitude_km, path.mu, path.length_km);
    for (int w = 0; w < lanes(); ++w) ray.transmittance[w] = std::exp(-depth(columns, w));
    if (path.meets_ground) set_ground(ray);
    return ray;
  }

  using Columns = std::array<double, P::MEDIA_SIZE>;  ///< km of density 1, by constituent

  /// Along the first `length` km of a ray.
  Columns column(double h, double mu, double length) {
    static const GaussRule rule = gauss_legendre(16);
    Columns sum{};
    std::vector<double> at = crossings(h, mu, length);
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      double width = at[i + 1] - at[i];
      for (std::size_t k = 0; width > 0 && k < rule.nodes.size(); ++k) {
        p_.densities(p_.altitude_after(h, mu, at[i] + width * rule.nodes[k]), density_);
        for (int c = 0; c < p_.MEDIA; ++c) sum[c] += width * rule.weights[k] * density_[c];
      }
    }
    return sum;
  }

 private:
  int lanes() const { return 4 * p_.GROUPS; }
  static void add(Values& to, const Values& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  }

  /// Altitudes between which every profile is smooth, close enough together for 16 points.
  std::vector<double> bends() const {
    double top = p_.scene.thickness_km;
    std::vector<double> all{0, top};
    for (double h = 0.25; h < top; h *= 1.5) all.push_back(h);
    int tent = p_.EXPONENTIALS;
    for (int i = 0; i < p_.TENTS; ++i, ++tent) {
      double half = 1 / p_.media[tent].b, centre = p_.media[tent].a;
      all.insert(all.end(), {centre - half, centre, centre + half});
    }
    for (const auto& node : p_.profile_nodes) all.push_back(node.x);
    std::erase_if(all, [&](double h) { return h < 0 || h > top; });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Distances in (0, length) at which a ray passes the altitudes of `bends`, and its lowest
  /// point.
  std::vector<double> crossings(double h, double mu, double length) {
    double r = p_.scene.planet_radius_km + h, b = r * mu;
    std::vector<double> at{0, length};
    for (double altitude : altitudes_) {
      double c = p_.squared_height(h) - p_.squared_height(altitude), d = b * b - c;
      if (d < 0) continue;
      at.push_back(-b - std::sqrt(d));
      at.push_back(-b + std::sqrt(d));
    }
    at.push_back(-b);
    std::erase_if(at, [&](double t) { return t < 0 || t > length; });
    std::sort(at.begin(), at.end());
    return at;
  }

  double depth(const Columns& columns, int lane) const {
    double sum = 0;
    for (int c = 0; c < p_.MEDIA; ++c) {
      sum += columns[c] * p_.extinction(c, lane / 4)[lane % 4];
    }
    return sum;
  }

  glm::dvec3 position(double t) const { return path_.start + path_.direction * t; }

  bool lit(double t) {
    glm::dvec3 x = position(t);
    double along = glm::dot(x, sun_);
    return along > 0 || glm::dot(x, x) - along * along >
                            p_.scene.planet_radius_km * p_.scene.planet_radius_km;
  }

  /// The view ray split where the density bends and at the edges of the planet's shadow: the
  /// cylinder |x|^2 - (x . sun)^2 = R^2.
  std::vector<double> view_pieces() {
    std::vector<double> at = crossings(path_.altitude_km, path_.mu, path_.length_km);
    double x_sun = glm::dot(path_.start, sun_), v_sun = glm::dot(path_.direction, sun_);
    double a = 1 - v_sun * v_sun;
    double b = glm::dot(path_.start, path_.direction) - x_sun * v_sun;
    double c = glm::dot(path_.start, path_.start) - x_sun * x_sun -
               p_.scene.planet_radius_km * p_.scene.planet_radius_km;
    if (a > 1e-14 && b * b - a * c > 0) {
      double root = std::sqrt(b * b - a * c);
      at.push_back((-b - root) / a);
      at.push_back((-b + root) / a);
    }
    add_skins(at);
    std::erase_if(at, [&](double t) { return t < 0 || t > path_.length_km; });
    std::sort(at.begin(), at.end());
    return at;
  }

  /// Where the air begins to hide and hides what lies behind, at each wavelength that it does:
  /// all light may come from too near to be found by halves.
  void add_skins(std::vector<double>& at) {
    const auto seen_through = [&](double t, int lane) {
      return depth(column(path_.altitude_km, path_.mu, t), lane);
    };
    for (int w = 0; w < lanes(); ++w) {
      constexpr double hides = 30;
      if (seen_through(path_.length_km, w) < hides) continue;
      for (double depths : {1.0, hides}) {
        double near = 0, far = path_.length_km;
        for (int i = 0; i < 60; ++i) {
          const double middle = 0.5 * (near + far);
          (seen_through(middle, w) < depths ? near : far) = middle;
        }
        at.push_back(far);
      }
    }
  }

  /// Integrand along the view ray: radiance a km.
  Values source(double t) {
    double h = p_.altitude_after(path_.altitude_km, path_.mu, t);
    glm::dvec3 x = position(t);
    double mu_sun = glm::dot(x, sun_) / glm::length(x);
    Columns to_camera = column(path_.altitude_km, path_.mu, t);
    Columns to_sun = column(h, mu_sun, p_.distance_to_top(h, mu_sun));
    p_.densities(h, density_);
    Values result(lanes());
    for (int w = 0; w < lanes(); ++w) {
      double scattered = 0;
      for (int c = 0; c < p_.MEDIA; ++c) {
        scattered += density_[c] * scattering_phase_[c * P::GROUPS_SIZE + w / 4][w % 4];
      }
      result[w] = scattered * std::exp(-depth(to_camera, w) - depth(to_sun, w));
    }
    return result;
  }

  Values gauss(double from, double to) {
    static const GaussRule rule = gauss_legendre(8);
    Values sum(lanes(), 0.0);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      Values value = source(from + (to - from) * rule.nodes[k]);
      for (int w = 0; w < lanes(); ++w) sum[w] += (to - from) * rule.weights[k] * value[w];
    }
    return sum;
  }

  Values adapt(double from, double to, const Values& whole, int level) {
    double middle = 0.5 * (from + to);
    Values left = gauss(from, middle), right = gauss(middle, to), both = left;
    add(both, right);
    double change = 0, size = 1e-12;
    for (int w = 0; w < lanes(); ++w) {
      change = std::max(change, std::abs(both[w] - whole[w]));
      largest_ = std::max(largest_, both[w]);
      size = std::max(size, both[w]);
    }
    if (change <= tolerance_ * size || change <= 1e-12 * largest_ || level > 12) return both;
    both = adapt(from, middle, left, level + 1);
    add(both, adapt(middle, to, right, level + 1));
    return both;
  }

  void set_ground(Ray& ray) {
    glm::dvec3 x = position(path_.length_km);
    double mu_sun = glm::dot(x, sun_) / glm::length(x);
    if (mu_sun <= 0) return;
    Columns to_sun = column(0, mu_sun, p_.distance_to_top(0, mu_sun));
    for (int w = 0; w < lanes(); ++w) {
      ray.ground[w] = p_.lambertian(w / 4)[w % 4] * mu_sun * std::exp(-depth(to_sun, w)) *
                      ray.transmittance[w];
    }
  }

  P p_;
  double tolerance_;
  std::vector<double> altitudes_;
  P::Path path_;
  glm::dvec3 sun_;
  double density_[P::MEDIA_SIZE] = {};
  glm::dvec4 scattering_phase_[P::MEDIA_GROUPS_SIZE] = {};
  double largest_ = 0;
};

}  // namespace cyanometer::oracle
