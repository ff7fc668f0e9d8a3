#include "engine/methods/moments/grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/methods/moments/phase_series.h"
#include "engine/optics/legendre.h"
#include "engine/optics/profile.h"
#include "engine/physics/pack.h"

namespace cyanometer {
namespace {

/// Mean altitude of what scatters, within bounds that leave nodes for all of the air.
double mean_altitude_km(const Problem& problem) {
  Physics<double> physics = pack<double>(problem);
  std::vector<const Medium*> media = packed_media(problem);
  constexpr int cells = 1000;
  double top = problem.thickness_km, depth = 0, moment = 0;
  double density[Physics<double>::MEDIA_SIZE];
  for (int i = 0; i < cells; ++i) {
    double h = (i + 0.5) / cells * top;
    physics.densities(h, density);
    for (std::size_t c = 0; c < media.size(); ++c) {
      double scattered = density[c] * std::ranges::max(media[c]->scattering_per_km);
      depth += scattered;
      moment += scattered * h;
    }
  }
  return std::clamp(depth > 0 ? moment / depth : 0.3 * top, 0.003 * top, 0.5 * top);
}

}  // namespace

template <class Real>
typename physics::Physics<Real>::MomentGrid moment_grid(const Problem& problem, int altitudes,
                                                        int suns) {
  double radius = problem.planet_radius_km, top = problem.thickness_km;
  double height = mean_altitude_km(problem);
  auto dip = [&](double h) { return std::acos(radius / (radius + h)); };
  double parallax =
      problem.sun_distance_km > 0 ? std::asin(radius / problem.sun_distance_km) : 0;
  // Measured on Earths with tops of 100 and 200 km and on planets of 400 km: the mean height at
  // 0.28 of the nodes, spacing at the shadow's edge set by that height's dip, an end where even
  // light scattered twice is a millionth.
  double power = std::clamp(std::log(height / top) / std::log(0.28), 1.0, 4.0);
  double reach = std::min(dip(top) + 2.7 * dip(height), 1.5) - parallax;
  typename physics::Physics<Real>::MomentGrid grid;
  grid.altitude_power = static_cast<Real>(power);
  grid.sun_shift_km = static_cast<Real>(height);
  grid.sun_width = static_cast<Real>(std::min(1.75 * std::sin(dip(height)), 1.0));
  grid.reach_sine = static_cast<Real>(std::sin(reach));
  grid.reach_cosine = static_cast<Real>(std::cos(reach));
  grid.parallax_sine = static_cast<Real>(std::sin(parallax));
  grid.parallax_cosine = static_cast<Real>(std::cos(parallax));
  grid.altitudes = altitudes;
  grid.suns = suns;
  return grid;
}

int degree_for(const Problem& problem) {
  // What the first moment left out scatters of a beam that crosses the air: in thick air light
  // has no peak left. An optical depth of a hundredth of it was measured to be worth up to a
  // hundredth of the radiance at the horizon.
  constexpr int molecules = 2, lowest = 4, highest = 8;
  constexpr double most_left_out = 0.004;
  if (std::ranges::none_of(problem.media, is_particle)) return molecules;
  std::size_t wavelengths = problem.wavelengths_nm.size();
  std::vector left_out(wavelengths, std::vector<double>(highest + 2));
  std::vector<double> depth(wavelengths);
  for (const Medium& medium : problem.media) {
    double column = column_km(medium.profile, problem.thickness_km);
    auto chi = legendre_coefficients(medium.phase, wavelengths, highest + 1);
    for (std::size_t w = 0; w < wavelengths; ++w) {
      double scattering = medium.scattering_per_km[w];
      depth[w] += (scattering + medium.absorption_per_km[w]) * column;
      for (int l = 0; l < highest + 2; ++l) left_out[w][l] += scattering * column * chi[w][l];
    }
  }
  int degree = lowest;
  for (std::size_t w = 0; w < wavelengths; ++w) {
    while (degree < highest && left_out[w][degree + 1] * std::exp(-depth[w]) > most_left_out) {
      degree += 2;
    }
  }
  return degree;
}

template physics::Physics<float>::MomentGrid moment_grid<float>(const Problem&, int, int);
template physics::Physics<double>::MomentGrid moment_grid<double>(const Problem&, int, int);

}  // namespace cyanometer
