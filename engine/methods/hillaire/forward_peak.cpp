#include "engine/methods/hillaire/forward_peak.h"

#include <numbers>

namespace cyanometer::hillaire {
namespace {

using P = Physics<double>;

/// By wavelength; 0 where nothing scatters. The midpoint rule, closest together in the peak.
std::vector<double> mean_cosines(const Problem& problem, const Medium& medium) {
  constexpr int samples = 2000;
  Problem alone = problem;
  alone.media = {medium};
  P physics = pack<double>(alone);
  glm::dvec4 phase[P::MEDIA_GROUPS_SIZE];
  std::vector<double> whole(problem.wavelengths_nm.size(), 0), along = whole;
  for (int i = 0; i < samples; ++i) {
    double x = (i + 0.5) / samples, theta = std::numbers::pi * x * x;
    physics.scattering_towards(
        physics.scattering_angle({0, 0, 1}, {std::sin(theta), 0, std::cos(theta)}), phase);
    for (std::size_t w = 0; w < whole.size(); ++w) {
      double part = phase[w / 4][static_cast<int>(w % 4)] * std::sin(theta) * x;
      whole[w] += part;
      along[w] += part * std::cos(theta);
    }
  }
  for (std::size_t w = 0; w < whole.size(); ++w)
    along[w] = whole[w] > 0 ? along[w] / whole[w] : 0;
  return along;
}

}  // namespace

Problem without_forward_peak(const Problem& problem, double share) {
  Problem scaled = problem;
  for (Medium& medium : scaled.media) {
    std::vector<double> cosines = mean_cosines(problem, medium);
    for (std::size_t w = 0; w < cosines.size(); ++w) {
      medium.scattering_per_km[w] *= 1 - share * std::max(cosines[w], 0.0);
    }
  }
  return scaled;
}

std::vector<glm::vec4> scattering_kept(const Problem& problem, const Problem& scaled) {
  Physics<float> before = pack<float>(problem), after = pack<float>(scaled);
  std::vector<glm::vec4> kept;
  for (int c = 0; c < before.MEDIA; ++c) {
    for (int group = 0; group < before.GROUPS; ++group) {
      glm::vec4 whole = before.scattering(c, group), share(1);
      for (int w = 0; w < 4; ++w) {
        if (whole[w] > 0) share[w] = after.scattering(c, group)[w] / whole[w];
      }
      kept.push_back(share);
    }
  }
  return kept;
}

std::vector<glm::vec4> scattering_kept(const Problem& problem,
                                       const std::vector<double>& shares_of_extinction) {
  Physics<float> physics = pack<float>(problem);
  std::vector<glm::vec4> kept;
  for (int c = 0; c < physics.MEDIA; ++c) {
    for (int group = 0; group < physics.GROUPS; ++group) {
      glm::vec4 scattering = physics.scattering(c, group),
                extinction = physics.extinction(c, group);
      glm::vec4 share(1);
      for (int w = 0; w < 4; ++w) {
        if (scattering[w] <= 0) continue;
        share[w] -= static_cast<float>(shares_of_extinction[c]) * extinction[w] / scattering[w];
      }
      kept.push_back(share);
    }
  }
  return kept;
}

}  // namespace cyanometer::hillaire
