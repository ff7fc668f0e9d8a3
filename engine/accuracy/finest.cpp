#include "engine/accuracy/finest.h"

#include <algorithm>

namespace cyanometer {

namespace {

bool may_have_heights(const Surface& surface) {
  if (const auto* world = std::get_if<ProceduralSurface>(&surface)) return world->relief_km > 0;
  const auto* map = std::get_if<MapSurface>(&surface);
  return map && !map->height.empty();
}

}  // namespace

Plan finest_plan(const Scene& scene, const std::vector<double>& wavelengths_nm) {
  Plan plan;
  plan.method = scene.method.scattering_orders.value_or(2) <= 1 ? "raymarch" : "moments";
  const auto& ladder =
      std::ranges::find(methods(), plan.method, &MethodDescription::name)->ladder;
  // A march that looks for heights before the sun has no time for as many nodes.
  const bool short_march = plan.method == "raymarch" && may_have_heights(scene.planet.surface);
  plan.options = ladder.at(ladder.size() - (short_march ? 2 : 1));
  plan.wavelengths_nm = wavelengths_nm;
  return plan;
}

std::vector<double> converged_wavelengths(const Scene& scene) {
  constexpr int many = 32;
  return scene.spectrum.wavelengths_nm.empty() ? colour_wavelengths(many)
                                               : scene.spectrum.wavelengths_nm;
}

RayColours::RayColours(const Scene& scene, const std::vector<double>& wavelengths_nm)
    : output_(make_output(scene, wavelengths_nm)) {}

std::vector<std::vector<double>> RayColours::error_channels(
    const std::vector<std::vector<double>>& radiance) const {
  std::vector<std::vector<double>> channels;
  for (const std::vector<double>& ray : radiance) {
    Triple xyz = sum(output_.xyz, ray);
    channels.emplace_back(xyz.begin(), xyz.end());
  }
  return channels;
}

Triple RayColours::rgb(const std::vector<double>& radiance) const {
  return sum(output_.rgb, radiance);
}

Triple RayColours::sum(const std::array<std::vector<double>, 3>& rows,
                       const std::vector<double>& radiance) const {
  Triple result{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t w = 0; w < radiance.size(); ++w) result[c] += rows[c][w] * radiance[w];
  }
  return result;
}

Watch part_of(const Watch& watch, double from, double to) {
  Watch part = watch;
  part.progress = [&watch, from, to](double share) {
    watch.progress(from + share * (to - from));
  };
  return part;
}

}  // namespace cyanometer
