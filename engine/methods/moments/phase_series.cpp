#include "engine/methods/moments/phase_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/optics/legendre.h"
#include "engine/optics/profile.h"
#include "engine/physics/pack.h"

namespace cyanometer {
namespace {

constexpr double four_pi = 4 * std::numbers::pi;
/// Nodes of the aureole's function, even in the fourth root of (1 - cos) / 2.
constexpr int aureole_nodes = 129;
/// Further terms of the sharpest peaks than this are below what the nodes resolve.
constexpr int most_terms = 4096;

/// Of a particle's coefficient chi_l what the moments scatter, before narrow peaks are widened;
/// the rest is the aureole's. Cut off at L the series would ring at all angles to a bright
/// horizon: measured in haze of optical depth 0.2, g 0.8 and suns from 60 to 5 deg, this filter
/// takes a third off the error.
double damped_end(int l, int degree) {
  return 1 - 0.4 * std::pow(static_cast<double>(l) / degree, 8);
}

double lowest_of(const std::vector<double>& series) {
  constexpr int angles = 180;
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= angles; ++i)
    lowest = std::min(lowest, legendre_sum(series, std::cos(std::numbers::pi * i / angles)));
  return lowest;
}

/// What the moments scatter, by l. A narrow peak's series would be negative beside the peak,
/// and light that is cut off at none there left dark and coloured patches in the sky (g 0.97,
/// optical depth 1): such a peak is as much wider, as heat spreads, as keeps the series from
/// falling further below none than 0.2 of its mean. Up to a g of 0.85 eight degrees hold it as
/// it is.
std::vector<double> kept_shares(const std::vector<double>& chi, double f, int degree) {
  std::vector<double> kept(degree + 1), series(degree + 1);
  auto lowest_if_spread = [&](double time) {
    for (int l = 0; l <= degree; ++l) {
      kept[l] = damped_end(l, degree) * std::exp(-time * l * (l + 1));
      series[l] = kept[l] * (chi[l] - f);
    }
    return lowest_of(series);
  };
  const double allowed = -0.2 * (1 - f);
  if (lowest_if_spread(0) >= allowed) return kept;
  double too_short = 0, enough = 1;
  for (int halving = 0; halving < 40; ++halving) {
    double middle = 0.5 * (too_short + enough);
    (lowest_if_spread(middle) < allowed ? too_short : enough) = middle;
  }
  lowest_if_spread(enough);
  return kept;
}

using Coefficients = std::vector<std::vector<double>>;  ///< [wavelength][l]

Coefficients coefficients_of(const Medium& medium, int degree) {
  return legendre_coefficients(medium.phase, medium.scattering_per_km.size(), degree);
}

/// Twice as many terms until the last one is nothing.
Coefficients all_coefficients(const Medium& medium, int degree) {
  Coefficients all = coefficients_of(medium, degree);
  auto unfinished = [](const std::vector<double>& chi) { return std::abs(chi.back()) > 1e-4; };
  while (degree < most_terms && std::ranges::any_of(all, unfinished)) {
    degree = std::min(2 * degree, most_terms);
    all = coefficients_of(medium, degree);
  }
  return all;
}

/// Share of a constituent's extinction that counts as not there, of chi_(L+1) half for a wide
/// peak and the more the narrower it is: the same at all wavelengths, so that it scales the
/// constituent's columns. With halves alone a sky of a narrow peak (g 0.97, optical depth 1,
/// sun at 33 deg) was twice as far from walks, their noise included.
double straight_on(const Medium& medium, const Coefficients& chi, int degree) {
  double share = 1;
  for (std::size_t w = 0; w < chi.size(); ++w) {
    double scattering = medium.scattering_per_km[w];
    double extinction = scattering + medium.absorption_per_km[w];
    double left_out = std::max(chi[w][degree + 1], 0.0);
    if (extinction > 0)
      share = std::min(share, left_out * (1 + left_out) / 2 * scattering / extinction);
  }
  return share;
}

class Layout {
 public:
  Layout(const Problem& problem, int degree)
      : media_(std::max<std::size_t>(problem.media.size(), 1)),
        groups_((problem.wavelengths_nm.size() + 3) / 4),
        terms_(2 * degree + 3),
        kept_(degree + 1),
        values_(media_ * ((terms_ + kept_) * groups_ + 1) + aureole_nodes * groups_,
                glm::vec4(0)) {}

  std::size_t terms() const { return terms_; }
  void set_series(std::size_t c, std::size_t l, std::size_t w, double value) {
    set((c * terms_ + l) * groups_, w, value);
  }
  void set_scattered(std::size_t c, std::size_t l, std::size_t w, double value) {
    set((media_ * terms_ + c * kept_ + l) * groups_, w, value);
  }
  void set_view_share(std::size_t c, double value) {
    values_[media_ * (terms_ + kept_) * groups_ + c].x = static_cast<float>(value);
  }
  void set_aureole(std::size_t node, std::size_t w, double value) {
    set(media_ * ((terms_ + kept_) * groups_ + 1) + node * groups_, w, value);
  }
  std::vector<glm::vec4> take() { return std::move(values_); }

 private:
  void set(std::size_t first, std::size_t w, double value) {
    values_[first + w / 4][static_cast<int>(w % 4)] = static_cast<float>(value);
  }

  std::size_t media_, groups_, terms_, kept_;
  std::vector<glm::vec4> values_;
};

/// What light near the sun, whose moments about the sun fall as those of the functions that
/// scattered it, adds beyond what of the moments is kept: sum over l of (2 l + 1) / (4 pi)
/// (1 - kept_l) (chi_l - f) X_l / X_(L+1) P_l, chi and X the mean over all particles.
struct Aureole {
  std::vector<double> left_out;   ///< mean of (1 - kept_l) (chi_l - f), by l
  std::vector<double> scattered;  ///< X_l
  double weight = 0;

  void add(const std::vector<double>& chi, double f, const std::vector<double>& kept,
           double depth) {
    std::size_t size = std::max(chi.size(), scattered.size());
    scattered.resize(size, 0.0);
    left_out.resize(size, 0.0);
    for (std::size_t l = 0; l < size; ++l) {
      double value = l < chi.size() ? chi[l] : 0.0;
      double share = l < kept.size() ? 1 - kept[l] : 1.0;
      scattered[l] += depth * value;
      left_out[l] += depth * share * (value - f);
    }
    weight += depth;
  }

  /// Coefficients of the function; none where there is nothing to tell them from.
  std::vector<double> series(int degree) const {
    std::size_t first = degree + 1;
    if (weight <= 0 || scattered.size() <= first || scattered[first] < 1e-6 * weight) return {};
    std::vector<double> all;
    for (std::size_t l = 0; l < scattered.size(); ++l)
      all.push_back(left_out[l] / weight * scattered[l] / scattered[first]);
    return all;
  }
};

void set_aureole(Layout& layout, std::size_t w, const Aureole& aureole, int degree) {
  const std::vector<double> series = aureole.series(degree);
  for (int node = 0; node < aureole_nodes; ++node) {
    double root = static_cast<double>(node) / (aureole_nodes - 1);
    layout.set_aureole(node, w,
                       legendre_sum(series, 1 - 2 * root * root * root * root) / four_pi);
  }
}

}  // namespace

bool is_particle(const Medium& medium) {
  return !std::holds_alternative<RayleighPhase>(medium.phase) &&
         std::ranges::any_of(medium.scattering_per_km, [](double s) { return s > 0; });
}

std::vector<std::vector<double>> legendre_coefficients(const PhaseFunction& phase,
                                                       std::size_t wavelengths, int degree) {
  if (auto* table = std::get_if<TabulatedPhase>(&phase)) {
    return tabulated_coefficients(table->angle_rad, table->values, degree);
  }
  std::vector<std::vector<double>> all(wavelengths);
  for (std::size_t w = 0; w < wavelengths; ++w) {
    if (auto* rayleigh = std::get_if<RayleighPhase>(&phase)) {
      all[w] = rayleigh_coefficients(rayleigh->gamma.empty() ? 0 : rayleigh->gamma[w], degree);
    } else if (auto* hg = std::get_if<HenyeyGreenstein>(&phase)) {
      all[w] = henyey_greenstein_coefficients(hg->g, degree);
    } else {
      all[w] = cornette_shanks_coefficients(std::get<CornetteShanks>(phase).g, degree);
    }
  }
  return all;
}

PhaseSeries make_phase_series(const Problem& problem, int degree, bool peaks) {
  Layout layout(problem, degree);
  PhaseSeries result;
  std::vector<Aureole> aureoles(problem.wavelengths_nm.size());
  std::vector<const Medium*> media = packed_media(problem);
  for (std::size_t c = 0; c < media.size(); ++c) {
    const Medium& medium = *media[c];
    layout.set_view_share(c, 1);
    result.straight_on.push_back(0);
    if (!std::ranges::any_of(medium.scattering_per_km, [](double s) { return s > 0; }))
      continue;
    bool particle = is_particle(medium);
    int terms = static_cast<int>(layout.terms());
    Coefficients chi =
        particle ? all_coefficients(medium, 4 * terms) : coefficients_of(medium, terms);
    double straight = particle && peaks ? straight_on(medium, chi, degree) : 0;
    layout.set_view_share(c, 1 - straight);
    result.straight_on.back() = straight;
    double column = column_km(medium.profile, problem.thickness_km);
    for (std::size_t w = 0; w < chi.size(); ++w) {
      double scattering = medium.scattering_per_km[w];
      double f = scattering > 0
                     ? straight * (scattering + medium.absorption_per_km[w]) / scattering
                     : 0;
      std::vector<double> kept =
          particle ? kept_shares(chi[w], f, degree) : std::vector<double>(degree + 1, 1.0);
      for (int l = 0; l <= degree; ++l) {
        layout.set_scattered(c, l, w, (chi[w][l] - f) * kept[l]);
      }
      for (int l = 0; l < terms; ++l) {
        // A smooth end of the series: cut off it would ring, and be negative.
        double beyond = std::max(l - degree, 0) / static_cast<double>(terms - degree);
        layout.set_series(c, l, w,
                          (2 * l + 1) / four_pi * chi[w][l] * std::exp(-2 * beyond * beyond));
      }
      if (particle) aureoles[w].add(chi[w], f, kept, scattering * column);
    }
    result.particles = result.particles || particle;
  }
  for (std::size_t w = 0; w < aureoles.size(); ++w) {
    set_aureole(layout, w, aureoles[w], degree);
  }
  result.values = layout.take();
  return result;
}

}  // namespace cyanometer
