#include "engine/stability/brightest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/problem.h"

namespace cyanometer {
namespace {

using std::numbers::pi;

double peak(const RayleighPhase&, std::size_t) { return 3 / (8 * pi); }
double peak(const HenyeyGreenstein& phase, std::size_t) {
  double g = std::abs(phase.g);
  return (1 + g) / (4 * pi * (1 - g) * (1 - g));
}
double peak(const CornetteShanks& phase, std::size_t) {
  double g = std::abs(phase.g);
  return 3 * (1 + g) / (4 * pi * (2 + g * g) * (1 - g) * (1 - g));
}
double peak(const TabulatedPhase& phase, std::size_t wavelength) {
  return std::ranges::max(phase.values[wavelength]);
}

/// Of the sun's light where the air comes nearest to it, over that at the planet's centre.
double nearest_irradiance(const Problem& problem) {
  if (problem.sun_distance_km == 0) return 1;
  double left_km = problem.sun_distance_km - problem.planet_radius_km - problem.thickness_km;
  if (left_km <= 0) return std::numeric_limits<double>::infinity();
  return std::pow(problem.sun_distance_km / left_km, 2);
}

}  // namespace

std::vector<double> brightest_possible(const Scene& scene,
                                       const std::vector<double>& wavelengths_nm) {
  const Problem problem = make_problem(scene, wavelengths_nm);
  std::vector<double> most = make_output(scene, wavelengths_nm).irradiance;
  constexpr int orders_at_most = 64;
  int orders = problem.scattering_orders < 0 ? orders_at_most : problem.scattering_orders;
  double beams = orders * nearest_irradiance(problem);
  if (problem.ground) beams = std::numeric_limits<double>::infinity();
  for (std::size_t w = 0; w < most.size(); ++w) {
    double per_beam = 1 / pi;
    for (const Medium& medium : problem.media) {
      if (medium.scattering_per_km[w] <= 0) continue;
      per_beam =
          std::max(per_beam, std::visit([&](auto& p) { return peak(p, w); }, medium.phase));
    }
    most[w] *= beams * per_beam;
  }
  return most;
}

}  // namespace cyanometer
