#include "engine/methods/path/guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/methods/path/light_guide.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

double total(const glm::dvec4& v) { return v.x + v.y + v.z + v.w; }

/// Scattering of every constituent where its density is 1, summed over the wavelengths, 1/km.
std::vector<double> scattering_of_media(const P& p) {
  std::vector<double> sums(p.MEDIA, 0.0);
  for (int c = 0; c < p.MEDIA; ++c) {
    for (int group = 0; group < p.GROUPS; ++group) sums[c] += total(p.scattering(c, group));
  }
  return sums;
}

/// A tabulated phase at one of its angles, averaged over the wavelengths as they scatter, 1/sr.
double mean_phase(const P& p, int c, int node) {
  double sum = 0, weights = 0;
  for (int group = 0; group < p.GROUPS; ++group) {
    sum += total(p.scattering(c, group) * p.phase_values[node * p.GROUPS + group]);
    weights += total(p.scattering(c, group));
  }
  return sum / weights;
}

/// Largest value, per isotropic one, of the phase towards the front.
double peak(const P& p, int c) {
  constexpr double sphere = 4 * std::numbers::pi;
  const auto& m = p.media[c];
  if (m.phase == P::PHASE_TABLE) return sphere * mean_phase(p, c, m.phase_node);
  bool analytic = m.phase == P::PHASE_HENYEY_GREENSTEIN || m.phase == P::PHASE_CORNETTE_SHANKS;
  return analytic ? (1 + m.g) / ((1 - m.g) * (1 - m.g)) : 1.5;
}

/// Light scattered by less than an angle, at each of many angles (not normalised).
struct Cumulative {
  std::vector<double> angle_rad, mass;
};

Cumulative cumulative_phase(const P& p, int c) {
  const auto& m = p.media[c];
  Cumulative result{{0.0}, {0.0}};
  constexpr int parts = 32;
  for (int i = 0; i + 1 < m.phase_nodes; ++i) {
    int node = m.phase_node + i;
    double from = p.phase_angles[node], width = p.phase_angles[node + 1] - from;
    double low = mean_phase(p, c, node), high = mean_phase(p, c, node + 1);
    for (int k = 0; k < parts; ++k) {
      double x = (k + 0.5) / parts;
      double value =
          low > 0 && high > 0 ? low * std::pow(high / low, x) : low + x * (high - low);
      result.mass.push_back(result.mass.back() +
                            value * std::sin(from + width * x) * width / parts);
      result.angle_rad.push_back(from + width * (k + 1) / parts);
    }
  }
  return result;
}

/// Edges in 1 - cos of cells between which a phase scatters equal shares of the light.
void append_cells(std::vector<double>& guide, const P& p, int c) {
  if (p.media[c].phase != P::PHASE_TABLE) {
    guide.insert(guide.end(), P::PHASE_CELLS + 1, 0.0);
    return;
  }
  Cumulative below = cumulative_phase(p, c);
  for (int edge = 0; edge <= P::PHASE_CELLS; ++edge) {
    double wanted = below.mass.back() * edge / P::PHASE_CELLS;
    auto at = std::lower_bound(below.mass.begin() + 1, below.mass.end() - 1, wanted);
    std::size_t i = at - below.mass.begin();
    double x = (wanted - below.mass[i - 1]) / (below.mass[i] - below.mass[i - 1]);
    double angle = below.angle_rad[i - 1] + x * (below.angle_rad[i] - below.angle_rad[i - 1]);
    if (edge == P::PHASE_CELLS) angle = std::numbers::pi;
    double half = std::sin(angle / 2);
    guide.push_back(2 * half * half);
  }
}

}  // namespace

void set_path_guide(P& p, const Problem& problem) {
  double column[P::MEDIA_SIZE];
  p.columns_to_top(0, 1, column);
  std::vector<double> scattering = scattering_of_media(p), peaked(p.MEDIA, 0.0);
  double all = 0, all_peaked = 0, log_scale = 0;
  for (int c = 0; c < p.MEDIA; ++c) {
    double depth = scattering[c] * column[c];
    if (depth <= 0) continue;
    all += depth;
    log_scale += depth * std::log(column[c]);
    if (peak(p, c) > 4) all_peaked += peaked[c] = depth;
  }
  std::vector<double>& guide = p.path_guide;
  guide = {all > 0 ? std::exp(log_scale / all) : p.scene.thickness_km,
           all_peaked > 0 ? 0.3 * std::sqrt(all_peaked / all) : 0.0};
  for (double depth : peaked) guide.push_back(all_peaked > 0 ? depth / all_peaked : 0.0);
  for (int c = 0; c < p.MEDIA; ++c) append_cells(guide, p, c);
  if (needs_light_guide(problem)) append_light_guide(p, problem);
}

}  // namespace cyanometer
