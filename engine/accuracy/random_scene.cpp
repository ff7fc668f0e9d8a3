#include "engine/accuracy/random_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/accuracy/dice.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json power_law(double value, double exponent) {
  return {{"power_law", {{"value", value}, {"at_nm", 550}, {"exponent", exponent}}}};
}

json exponential(double scale_height_km) {
  return {{"type", "exponential"}, {"scale_height_km", scale_height_km}};
}

/// Molecules by the optical depth of their exponential column, which ends at the top.
json air(Dice& dice, double scale_height_km, double thickness_km) {
  double column = scale_height_km * (1 - std::exp(-thickness_km / scale_height_km));
  return {{"type", "molecules"},
          {"scattering_per_km", power_law(dice.logarithmic(0.003, 3) / column, -4)},
          {"profile", exponential(scale_height_km)}};
}

json haze(Dice& dice, double scale_height_km) {
  const char* phase = dice.chance(0.5) ? "henyey_greenstein" : "cornette_shanks";
  return {{"type", "particles"},
          {"optical_depth", power_law(dice.logarithmic(0.01, 10), dice.uniform(-2, 0.5))},
          {"single_scattering_albedo", dice.uniform(0.6, 1)},
          {"profile", exponential(scale_height_km * dice.uniform(0.1, 1))},
          {"phase", {{"type", phase}, {"g", dice.uniform(-0.3, 0.95)}}}};
}

json absorber(Dice& dice, double thickness_km) {
  double half_width = thickness_km * dice.uniform(0.05, 0.2);
  double centre = dice.uniform(half_width, 0.6 * thickness_km);
  return {
      {"type", "absorber"},
      {"absorption_per_km",
       power_law(dice.logarithmic(0.01, 1) / half_width, dice.uniform(-3, 3))},
      {"profile", {{"type", "tent"}, {"centre_km", centre}, {"half_width_km", half_width}}}};
}

/// From tables' sizes to a screen's.
json image(Dice& dice) {
  const int width = static_cast<int>(std::lround(dice.logarithmic(128, 1280)));
  return {{"width", width}, {"height", std::max(1, width * 9 / 16)}};
}

json camera(Dice& dice, double radius_km, double thickness_km) {
  double kind = dice.uniform(0, 1), heading = dice.uniform(-180, 180);
  if (kind < 0.4) {
    return {{"altitude_km", 0.002},
            {"heading_deg", heading},
            {"pitch_deg", dice.uniform(0, 60)},
            {"fov_deg", dice.uniform(40, 100)}};
  }
  if (kind < 0.7) {
    return {{"altitude_km", dice.uniform(0, 1) * thickness_km},
            {"heading_deg", heading},
            {"pitch_deg", dice.uniform(-30, 30)},
            {"fov_deg", dice.uniform(40, 100)}};
  }
  // Outside: at the disc, or at its limb.
  double altitude = std::min(thickness_km + radius_km * dice.logarithmic(0.05, 20), 1e6);
  double radius_deg =
      std::asin((radius_km + thickness_km) / (radius_km + altitude)) * 180 / std::numbers::pi;
  bool limb = dice.chance(0.4);
  return {{"altitude_km", altitude},
          {"heading_deg", heading},
          {"pitch_deg", limb ? radius_deg - 90 : -90},
          {"fov_deg", std::clamp(radius_deg * (limb ? 0.5 : 2.2), 1.0, 140.0)}};
}

}  // namespace

json random_scene(std::uint64_t seed) {
  Dice dice(seed);
  double radius = dice.logarithmic(300, 60000);
  double thickness = radius * dice.logarithmic(0.005, 0.3);
  double scale_height = std::min(thickness / dice.uniform(6, 16), 1000.0);
  json constituents{{"air", nullptr}, {"aerosol", nullptr}, {"ozone", nullptr}};
  bool clean = dice.chance(0.3), airless = dice.chance(0.1);
  if (!airless) constituents["air"] = air(dice, scale_height, thickness);
  if (!clean || airless) constituents["haze"] = haze(dice, scale_height);
  if (dice.chance(0.5)) constituents["absorber"] = absorber(dice, thickness);
  json scene{
      {"planet", {{"radius_km", radius}, {"ground_albedo", dice.uniform(0, 0.9)}}},
      {"atmosphere", {{"thickness_km", thickness}, {"constituents", constituents}}},
      {"sun",
       {{"elevation_deg", dice.uniform(-12, 90)}, {"azimuth_deg", dice.uniform(-180, 180)}}},
      {"camera", camera(dice, radius, thickness)},
      {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}};
  scene["image"] = image(dice);
  return scene;
}

}  // namespace cyanometer
