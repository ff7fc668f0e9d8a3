#include "engine/methods/orders.h"

#include <algorithm>

#include "engine/methods/moments/phase_series.h"
#include "engine/optics/profile.h"

namespace cyanometer {

namespace {

/// By wavelength.
std::vector<double> scattering_depths(const Problem& problem) {
  std::size_t wavelengths = problem.wavelengths_nm.size();
  std::vector<double> depth(wavelengths);
  for (const Medium& medium : problem.media) {
    double column = column_km(medium.profile, problem.thickness_km);
    auto chi = legendre_coefficients(medium.phase, wavelengths, 1);
    for (std::size_t w = 0; w < wavelengths; ++w) {
      depth[w] += medium.scattering_per_km[w] * column * (1 - std::max(chi[w][1], 0.0) / 2);
    }
  }
  return depth;
}

}  // namespace

double scattering_depth(const Problem& problem) {
  return std::ranges::max(scattering_depths(problem));
}

double order_ratio(const Problem& problem) {
  std::vector<double> depth = scattering_depths(problem);
  double largest = 0;
  for (std::size_t w = 0; w < depth.size(); ++w) {
    double air = 1.5 * depth[w] / (1 + 1.5 * depth[w]);
    largest = std::max(largest, air + problem.ground_albedo[w] * (1 - air) * air);
  }
  return largest;
}

int orders_until_geometric(const Problem& problem) {
  double ratio = order_ratio(problem);
  // Three at least: light goes from the sun to the ground, to the air, and back to the ground;
  // where that is bright, once or twice more.
  int least = 3 + static_cast<int>(2.5 * std::ranges::max(problem.ground_albedo));
  return least + static_cast<int>(std::min(2.5 * ratio / std::max(1 - ratio, 0.04), 60.0));
}

}  // namespace cyanometer
