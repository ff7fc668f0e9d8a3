#include "engine/surface/world.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <vector>

#include "engine/gauss_legendre.h"
#include "engine/surface/pack_ground.h"

namespace cyanometer {
namespace {

using P = physics::Physics<double>;

/// What was found once, for all threads.
template <class Key, class Value>
class Known {
 public:
  template <class Find>
  Value get(const Key& key, const Find& find) {
    constexpr std::size_t most = 4096;
    std::lock_guard lock(mutex_);
    if (auto found = known_.find(key); found != known_.end()) return found->second;
    if (known_.size() >= most) known_.clear();
    return known_[key] = find(key);
  }

 private:
  std::mutex mutex_;
  std::map<Key, Value> known_;
};

/// Of the whole sphere, spread evenly [Fibonacci lattice; Gonzalez 2010].
std::vector<glm::dvec3> places() {
  constexpr int count = 6000;
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i) {
    double z = 1 - (2 * i + 1.0) / count, rim = std::sqrt(1 - z * z),
           angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    all.emplace_back(rim * std::cos(angle), rim * std::sin(angle), z);
  }
  return all;
}

/// On a sphere of radius 1.
P terrain_of(const ProceduralSurface& surface) {
  P p;
  p.scene.planet_radius_km = 1;
  p.surface_values.assign(P::SURFACE_SPECTRA, glm::dvec4(0));
  p.surface_values[0].z = terrain_gain(surface);
  p.surface_values[1] = {surface.ice_latitude_deg, surface.vegetation, surface.seed, 0};
  tell_places_from_centre(p);
  return p;
}

World explore(const ProceduralSurface& surface) {
  constexpr double footprint = 1.0 / 256;
  P p = terrain_of(surface);
  std::vector<glm::dvec3> all = places();
  std::vector<double> continents;
  for (const glm::dvec3& n : all) continents.push_back(p.terrain_at(n, footprint).continent);
  std::ranges::sort(continents);
  // Beyond what the continents reach where there is no sea, or nothing else.
  constexpr double beyond = 10;
  World world;
  auto count = static_cast<double>(continents.size());
  auto under = static_cast<std::size_t>(surface.sea_fraction * count);
  world.sea_level = surface.sea_fraction <= 0 ? -beyond
                    : surface.sea_fraction >= 1
                        ? beyond
                        : continents[std::min(under, continents.size() - 1)];
  p.surface_values[0].y = world.sea_level;
  for (const glm::dvec3& n : all) {
    double share[P::MATTERS];
    p.matter_of(n, p.terrain_at(n, footprint), share);
    for (int m = 0; m < P::MATTERS; ++m) world.mean_share[m] += share[m] / count;
  }
  for (double& share : world.mean_share) share = std::round(share * 100) / 100;
  double sum = 0;
  for (double share : world.mean_share) sum += share;
  for (double& share : world.mean_share) share /= sum;
  return world;
}

}  // namespace

World world_of(const ProceduralSurface& s) {
  static Known<std::array<double, 5>, World> known;
  std::array<double, 5> key{static_cast<double>(s.seed), s.sea_fraction, s.roughness,
                            s.ice_latitude_deg, s.vegetation};
  return known.get(key, [&](const auto&) { return explore(s); });
}

double terrain_gain(const ProceduralSurface& surface) { return 0.4 + 0.2 * surface.roughness; }

double sea_slope_variance(const ProceduralSurface& surface) {
  return 0.003 + 0.00512 * surface.wind_m_per_s;
}

namespace {

/// Of sea_glint over all lights, by facets: so drawn that their slopes are as likely as the
/// sea's.
double reflectance_towards(P& p, double mu) {
  constexpr int rings = 96, spokes = 48;
  double variance = p.surface_values[0].w, sum = 0;
  glm::dvec3 eye(std::sqrt(1 - mu * mu), 0, mu);
  for (int i = 0; i < rings; ++i) {
    double tangent = std::sqrt(-variance * std::log(1 - (i + 0.5) / rings));
    double likely = std::exp(-tangent * tangent / variance) / (std::numbers::pi * variance);
    for (int k = 0; k < spokes; ++k) {
      double angle = 2 * std::numbers::pi * (k + 0.5) / spokes;
      glm::dvec3 facet =
          glm::normalize(glm::dvec3(tangent * std::cos(angle), tangent * std::sin(angle), 1));
      double turned = glm::dot(facet, eye);
      glm::dvec3 light = 2 * turned * facet - eye;
      if (turned <= 0 || light.z <= 0) continue;
      // A light's solid angle is 4 cos that of its facet, this cos^3 of the slopes'.
      sum += p.sea_glint(light, eye) * light.z * 4 * turned * std::pow(facet.z, 3) / likely;
    }
  }
  return sum / (rings * spokes);
}

SeaReflectance reflectance_of(double variance) {
  P p;
  p.surface_values.assign(P::SURFACE_SPECTRA, glm::dvec4(0));
  p.surface_values[0].w = variance;
  SeaReflectance sea;
  for (int i = 0; i < P::SEA_NODES; ++i) {
    double x = std::max(static_cast<double>(i), 0.05) / (P::SEA_NODES - 1);
    sea.by_cosine[i] = reflectance_towards(p, x * x);
    p.surface_values[P::SURFACE_SEA + i / 4][i % 4] = sea.by_cosine[i];
  }
  static const GaussRule rule = gauss_legendre(64);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    sea.mean += rule.weights[i] * 2 * rule.nodes[i] * p.sea_reflectance(rule.nodes[i]);
  }
  return sea;
}

}  // namespace

SeaReflectance sea_reflectance(double slope_variance) {
  static Known<double, SeaReflectance> known;
  return known.get(slope_variance, reflectance_of);
}

}  // namespace cyanometer
