#include "engine/irradiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/gauss_legendre.h"

namespace cyanometer {
namespace {

constexpr double pi = std::numbers::pi;

/// Elevations (radians) between which radiance is smooth, ascending from `low` to `high`.
std::vector<double> smooth_pieces(const Problem& problem, double low, double high) {
  double r = problem.planet_radius_km + problem.camera.altitude_km;
  double r_top = problem.planet_radius_km + problem.thickness_km;
  double sun = std::asin(std::clamp(problem.sun_direction[2], -1.0, 1.0));
  std::vector<double> pieces{low, high, sun, -std::acos(problem.planet_radius_km / r)};
  if (r > r_top) pieces.push_back(-std::acos(r_top / r));
  std::sort(pieces.begin(), pieces.end());
  std::erase_if(pieces, [&](double x) { return x < low || x > high; });
  pieces.erase(std::unique(pieces.begin(), pieces.end(),
                           [](double a, double b) { return b - a < 1e-9; }),
               pieces.end());
  return pieces;
}

}  // namespace

HemisphereRule hemisphere_rule(const Problem& problem, bool upper) {
  constexpr int elevations = 20, azimuths = 24;
  static const GaussRule along = gauss_legendre(elevations), around = gauss_legendre(azimuths);
  HemisphereRule rule;
  double sun_azimuth = std::atan2(problem.sun_direction[0], problem.sun_direction[1]);
  std::vector<double> pieces =
      upper ? smooth_pieces(problem, 0, pi / 2) : smooth_pieces(problem, -pi / 2, 0);
  for (std::size_t piece = 0; piece + 1 < pieces.size(); ++piece) {
    double low = pieces[piece], width = pieces[piece + 1] - low;
    for (int i = 0; i < elevations; ++i) {
      // Points gather at both ends of a piece: there are the horizon, the limb or the sun.
      double t = along.nodes[i], s = t * t * (3 - 2 * t), ds = 6 * t * (1 - t);
      double elevation = low + width * s;
      double ring =
          along.weights[i] * ds * width * std::cos(elevation) * std::abs(std::sin(elevation));
      for (int k = 0; k < azimuths; ++k) {
        // Radiance is even about the sun's azimuth, and strongest there.
        double u = around.nodes[k], from_sun = pi * u * u;
        double weight = ring * around.weights[k] * 2 * pi * u;
        for (double side : {-1.0, 1.0}) {
          double azimuth = sun_azimuth + side * from_sun;
          rule.directions.emplace_back(std::cos(elevation) * std::sin(azimuth),
                                       std::cos(elevation) * std::cos(azimuth),
                                       std::sin(elevation));
          rule.weights.push_back(weight);
        }
      }
    }
  }
  return rule;
}

}  // namespace cyanometer
