#include "engine/physics/kinks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cyanometer {
namespace {

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};

struct Kink {
  double altitude_km;
  double
      depth;  ///< optical depth, vertically, that a rule which doesn't see it may be wrong by
};

double largest_extinction(const Medium& medium) {
  double largest = 0;
  for (std::size_t w = 0; w < medium.scattering_per_km.size(); ++w) {
    largest = std::max(largest, medium.scattering_per_km[w] + medium.absorption_per_km[w]);
  }
  return largest;
}

void append(std::vector<Kink>& kinks, const TentProfile& tent, double extinction, double) {
  double depth = extinction * tent.half_width_km;
  for (double side : {-1.0, 0.0, 1.0}) {
    kinks.push_back({tent.centre_km + side * tent.half_width_km, depth});
  }
}

/// The slope of the density above a node, by its secant.
double slope(const TableProfile& table, std::size_t i) {
  return (table.density[i + 1] - table.density[i]) /
         (table.altitude_km[i + 1] - table.altitude_km[i]);
}

void append(std::vector<Kink>& kinks, const TableProfile& table, double extinction, double) {
  const auto& h = table.altitude_km;
  for (std::size_t i = 0; i < h.size(); ++i) {
    bool first = i == 0, last = i + 1 == h.size();
    double below = first ? 0 : slope(table, i - 1), above = last ? 0 : slope(table, i);
    double width = std::min(first ? 1e9 : h[i] - h[i - 1], last ? 1e9 : h[i + 1] - h[i]);
    double jump = last ? table.density[i] : 0;
    double bend = std::abs(above - below) * width;
    if (h.size() > 1) kinks.push_back({h[i], extinction * width * (bend + jump)});
  }
}

/// A dense layer has an edge of its own: where light that passes it horizontally goes out
/// within a scale height. The optical depth there is sqrt(2 pi R H) times the extinction.
void append(std::vector<Kink>& kinks, const ExponentialProfile& profile, double extinction,
            double radius_km) {
  double height_km = profile.scale_height_km;
  double at_ground = extinction * std::sqrt(2 * std::numbers::pi * radius_km * height_km);
  for (double depth = 10; depth < at_ground / 2; depth *= 10) {
    kinks.push_back({height_km * std::log(at_ground / depth), extinction * height_km});
  }
}

}  // namespace

std::vector<double> profile_kinks_km(const Problem& problem) {
  constexpr double least_depth = 1e-4;
  constexpr std::size_t most = 12;
  std::vector<Kink> kinks;
  for (const Medium& medium : problem.media) {
    double extinction = largest_extinction(medium);
    std::visit(Overloaded{[](const UniformProfile&) {}, [](const QuadraticProfile&) {},
                          [&](const auto& profile) {
                            append(kinks, profile, extinction, problem.planet_radius_km);
                          }},
               medium.profile);
  }
  std::erase_if(kinks, [&](const Kink& kink) {
    return kink.depth < least_depth || kink.altitude_km <= 0 ||
           kink.altitude_km >= problem.thickness_km;
  });
  std::ranges::sort(kinks, std::greater(), &Kink::depth);
  if (kinks.size() > most) kinks.resize(most);
  std::vector<double> altitudes;
  for (const Kink& kink : kinks) altitudes.push_back(kink.altitude_km);
  std::ranges::sort(altitudes);
  auto repeated = std::ranges::unique(altitudes);
  altitudes.erase(repeated.begin(), repeated.end());
  return altitudes;
}

}  // namespace cyanometer
