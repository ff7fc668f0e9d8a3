#include "engine/methods/limits.h"

#include <algorithm>
#include <cmath>

#include "engine/methods/moments/grid.h"
#include "engine/methods/moments/phase_series.h"
#include "engine/optics/colour.h"
#include "engine/optics/profile.h"

namespace cyanometer {
namespace {

constexpr double degree = 57.29577951308232;

void add_particles(const Medium& medium, const Problem& problem, SceneTraits& traits) {
  double column = column_km(medium.profile, problem.thickness_km);
  double scattered = std::ranges::max(medium.scattering_per_km) * column;
  if (scattered < 0.01 || std::holds_alternative<RayleighPhase>(medium.phase)) return;
  traits.haze += scattered;
  for (const auto& series :
       legendre_coefficients(medium.phase, problem.wavelengths_nm.size(), 1)) {
    traits.asymmetry = std::max(traits.asymmetry, series[1]);
  }
}

}  // namespace

SceneTraits traits_of(const Problem& problem) {
  SceneTraits traits{.sun_deg = std::asin(problem.sun_direction[2]) * degree,
                     .depth = largest_depth(problem),
                     .altitude_km = problem.camera.altitude_km,
                     .thickness_km = problem.thickness_km,
                     .scattering_orders = problem.scattering_orders,
                     .varied_ground = problem.ground.has_value()};
  traits.near_sun = problem.sun_distance_km > 0;
  if (problem.sun_disc_samples > 1)
    traits.sun_diameter_deg = 2 * problem.sun_angular_radius_rad * degree;
  for (const Medium& medium : problem.media) add_particles(medium, problem, traits);
  return traits;
}

std::vector<std::string> limits_near(const Scene& scene, const std::string& method) {
  std::vector<double> wavelengths = scene.spectrum.wavelengths_nm;
  if (wavelengths.empty()) wavelengths = colour_wavelengths(4);
  SceneTraits traits = traits_of(make_problem(scene, wavelengths));
  std::vector<std::string> words;
  for (const MethodDescription& each : methods()) {
    if (each.name != method) continue;
    for (const MethodLimit& limit : each.limits) {
      if (!limit.near || limit.near(traits)) words.push_back(limit.words);
    }
  }
  return words;
}

}  // namespace cyanometer
