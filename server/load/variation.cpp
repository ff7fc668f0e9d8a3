#include "server/load/variation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/image/encode.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Where a thing that goes evenly to and fro between -1 and 1 is; the period is irrational, so
/// that it is never where it was before.
double swing(std::size_t number) {
  constexpr double period = 150 * std::numbers::phi;
  const double phase = std::fmod(static_cast<double>(number) / period, 1);
  return 2 * std::fabs(2 * phase - 1) - 1;
}

/// Moves an angle by up to `reach`, kept within what scenes may say.
void turn(json& angle_deg, double at, double reach, double most) {
  const double middle = std::clamp(angle_deg.get<double>(), reach - most, most - reach);
  angle_deg = middle + reach * at;
}

/// Turns and climbs.
void move_camera(json& camera, double at) {
  turn(camera.at("heading_deg"), at, 30, 360);
  turn(camera.at("pitch_deg"), at, 5, 90);
  json& altitude_km = camera.at("altitude_km");
  altitude_km = altitude_km.get<double>() * (1 + 0.05 * (at - 1));
}

void move_sun(json& sun, double at) {
  turn(sun.at("elevation_deg"), at, 10, 90);
  turn(sun.at("azimuth_deg"), at, 20, 360);
}

/// A spectrum, or a number, at every wavelength.
void multiply(json& amount, double factor) {
  if (amount.is_number()) {
    amount = factor * amount.get<double>();
  } else if (amount.is_array()) {
    for (json& each : amount) multiply(each, factor);
  } else {
    for (const char* part : {"power_law", "value", "values"}) {
      if (amount.contains(part)) multiply(amount[part], factor);
    }
  }
}

/// Every constituent between all that there is of it and four fifths.
void thin(json& atmosphere, double at) {
  const double share = 1 + 0.1 * (at - 1);
  for (json& constituent : atmosphere.at("constituents")) {
    for (const char* amount : {"pressure_pa", "scattering_per_km", "absorption_per_km",
                               "optical_depth", "dobson_units"}) {
      if (constituent.contains(amount)) multiply(constituent[amount], share);
    }
    if (constituent.contains("visibility_km"))
      multiply(constituent["visibility_km"], 1 / share);
  }
}

/// Of the format that the scene names; a picture's usual one is.
bool has_exposure(const json& scene) {
  const std::string format = scene.value(json::json_pointer("/image/format"), "png");
  return std::ranges::any_of(
      encodings(), [&](const Encoding& each) { return each.name == format && each.displayed; });
}

/// Whether frames can be told without reading what the scene is.
bool as_it_is(const json& scene, Variation variation) {
  return variation == Variation::nothing ||
         (variation == Variation::exposure && has_exposure(scene));
}

constexpr double hair = 1e-9;

/// What nobody sees, and yet another frame.
void change_by_a_hair(json& scene, std::size_t number) {
  const double hairs = hair * static_cast<double>(number);
  if (has_exposure(scene)) {
    scene["image"]["exposure_ev"] = hairs;
  } else {
    turn(scene.at("camera").at("roll_deg"), hairs, 1, 180);
  }
}

}  // namespace

const std::vector<std::string>& variation_names() {
  static const std::vector<std::string> names{"nothing", "exposure",   "camera",
                                              "sun",     "atmosphere", "everything"};
  return names;
}

const std::string& name_of(Variation variation) {
  return variation_names().at(static_cast<std::size_t>(variation));
}

Variation variation_of(const std::string& name) {
  const auto& names = variation_names();
  return static_cast<Variation>(std::ranges::find(names, name) - names.begin());
}

Motion::Motion(const json& scene, Variation variation)
    : variation_(variation),
      scene_(as_it_is(scene, variation) ? scene : canonical(read_scene(scene))) {}

json Motion::frame(std::size_t number) const {
  json scene = scene_;
  const auto varies = [&](Variation part) {
    return variation_ == part || variation_ == Variation::everything;
  };
  if (variation_ == Variation::exposure) change_by_a_hair(scene, number);
  if (varies(Variation::camera)) move_camera(scene.at("camera"), swing(number));
  if (varies(Variation::sun)) move_sun(scene.at("sun"), swing(number));
  if (varies(Variation::atmosphere)) thin(scene.at("atmosphere"), swing(number));
  return scene;
}

}  // namespace cyanometer
