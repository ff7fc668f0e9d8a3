#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/stability/row.h"

namespace cyanometer {

using nlohmann::json;

const std::vector<StabilityRow>& stability_rows() {
  static const std::vector<StabilityRow> rows = [] {
    std::vector<StabilityRow> all;
    for (const auto& part :
         {rows_of_rays(), rows_of_suns(), rows_of_airs(), rows_of_energy(), rows_of_work()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    std::ranges::sort(all, {}, &StabilityRow::number);
    return all;
  }();
  return rows;
}

json plain_scene() {
  return {{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
          {"sun", {{"irradiance", 1}}},
          {"image", {{"width", 160}, {"height", 90}}}};
}

json empty_scene() {
  return changed(
      plain_scene(),
      {{"planet", {{"ground_albedo", 0}}},
       {"atmosphere",
        {{"constituents", {{"air", nullptr}, {"aerosol", nullptr}, {"ozone", nullptr}}}}}});
}

json changed(json scene, const json& patch) {
  for (const auto& [name, value] : patch.items()) {
    if (value.is_object() && scene.contains(name) && scene[name].is_object() &&
        !value.contains("type")) {
      scene[name] = changed(scene[name], value);
    } else {
      scene[name] = value;  // null too: it removes or restores when the scene is read
    }
  }
  return scene;
}

std::vector<Measured> measured(const std::optional<Measured>& found) {
  if (!found) return {};
  return {*found};
}

double noise_of(const Radiances& seen, std::size_t ray, std::size_t channel) {
  return seen.standard_error ? 5 * (*seen.standard_error)[ray][channel] : 0;
}

double together(std::initializer_list<double> noises) {
  double squares = 0;
  for (double noise : noises) squares += noise * noise;
  return std::sqrt(squares);
}

Measured apart(double a, double b, double noise) {
  double larger = std::max(std::abs(a), std::abs(b));
  if (!(larger > 0)) return 0;
  return {std::max(std::abs(a - b) - noise, 0.0) / larger, noise / larger};
}

Measured larger(const Measured& a, const Measured& b) {
  Measured worst = b.least > a.least ? b : a;
  worst.noise = std::max(a.noise, b.noise);
  return worst;
}

Measured largest(std::size_t rays,
                 const std::function<Measured(std::size_t, std::size_t)>& of) {
  Measured most = 0;
  for (std::size_t ray = 0; ray < rays; ++ray) {
    for (std::size_t channel = 0; channel < 3; ++channel) most = larger(most, of(ray, channel));
  }
  return most;
}

}  // namespace cyanometer
