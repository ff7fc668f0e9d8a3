// Rows about what the air is made of: thin layers, peaks, small planets, pure and extreme
// media.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/document.h"
#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;

json with(json scene, const char* name, const json& constituent) {
  return changed(std::move(scene), {{"atmosphere", {{"constituents", {{name, constituent}}}}}});
}

json exponential(double scale_height_km) {
  return {{"type", "exponential"}, {"scale_height_km", scale_height_km}};
}

json power_law(double value, double exponent) {
  return {{"power_law", {{"value", value}, {"at_nm", 550}, {"exponent", exponent}}}};
}

json haze(const json& optical_depth, const json& albedo, double scale_height_km, double g) {
  return {{"type", "particles"},
          {"optical_depth", optical_depth},
          {"single_scattering_albedo", albedo},
          {"profile", exponential(scale_height_km)},
          {"phase", {{"type", "henyey_greenstein"}, {"g", g}}}};
}

json sun_at(json scene, double elevation_deg) {
  return changed(std::move(scene), {{"sun", {{"elevation_deg", elevation_deg}}}});
}

/// Directions so many degrees from the sun, above it and beside it.
std::vector<Direction> around(double sun_deg, const std::vector<double>& angles_deg) {
  std::vector<Direction> rays;
  for (double angle : angles_deg) {
    rays.push_back({sun_deg + angle, 0});
    double s = sun_deg * degree, a = angle * degree;
    rays.push_back({std::asin(std::cos(a) * std::sin(s)) / degree,
                    std::atan2(std::sin(a), std::cos(a) * std::cos(s)) / degree});
  }
  return rays;
}

StabilityRow coloured_haze() {
  StabilityRow row{.number = 3,
                   .name = "Colour of haze at a low sun",
                   .trigger = "optical depth",
                   .quantity = "error of the worst channel, 2 to 40 deg from the sun",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {0.05, 0.2, 0.5},
                   .hardest = 0.2};
  row.scene = [](double x) {
    json scene =
        with(plain_scene(), "aerosol", haze(power_law(x, -2), {0.98, 0.93, 0.8}, 1.2, 0.76));
    scene["atmosphere"]["constituents"]["aerosol"]["single_scattering_albedo"] = {
        {"wavelengths_nm", {440, 550, 680}}, {"values", {0.8, 0.93, 0.98}}};
    return changed(sun_at(scene, 4), {{"camera", {{"pitch_deg", 8}, {"fov_deg", 50}}}});
  };
  row.measure = [scene = row.scene](Trial& trial, double x) {
    return measured(trial.error_by_channel(scene(x), around(4, {2, 4, 8, 15, 25, 40})));
  };
  return row;
}

/// From row to row, of the log of radiance.
Measured steepest_bend(Trial& trial, const json& scene, const std::vector<Direction>& rows) {
  Radiances seen = trial.look(scene, rows);
  return largest(rows.size(), [&](std::size_t i, std::size_t c) -> Measured {
    if (i == 0 || i + 1 == rows.size()) return 0;
    double here = seen.radiance[i][c];
    double bend = seen.radiance[i - 1][c] - 2 * here + seen.radiance[i + 1][c];
    double noise = together(
        {noise_of(seen, i - 1, c), 2 * noise_of(seen, i, c), noise_of(seen, i + 1, c)});
    return {std::max(std::abs(bend) - noise, 0.0) / here, noise / here};
  });
}

StabilityRow packed_floats() {
  StabilityRow row{.number = 11,
                   .name = "Steps of small floats",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "second difference of the log of radiance from row to row of 0.02 "
                       "deg below the zenith; error of the hue within 6 deg of it",
                   .bound = 0.01,
                   .stated_errors = 1,
                   .sweep = {50, 10},
                   .hardest = 10};
  row.scene = [](double x) {
    return changed(sun_at(plain_scene(), x), {{"camera", {{"pitch_deg", 70}}}});
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    Measured bent = steepest_bend(trial, scene(x), fan(spaced(84, 88, 200), {90}));
    auto hue = trial.error_of_hue(scene(x), fan({84, 86, 88, 90}, {0, 90, 180, 270}));
    return hue ? std::vector{bent, *hue} : std::vector{bent};
  };
  return row;
}

StabilityRow forward_peaks() {
  StabilityRow row{.number = 13,
                   .name = "Forward peaks",
                   .trigger = "g",
                   .quantity = "error 1 to 10 deg from the sun, optical depths 1 and 8",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {0.9, 0.95, 0.99},
                   .hardest = 0.9};
  auto scene = [](double g, double depth) {
    return changed(sun_at(with(plain_scene(), "aerosol", haze(depth, 1, 1.2, g)), 40),
                   {{"camera", {{"pitch_deg", 40}, {"fov_deg", 25}}}});
  };
  row.scene = [scene](double x) { return scene(x, 1); };
  row.measure = [scene](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = around(40, {1, 2, 3, 5, 7, 10});
    auto thin = trial.error(scene(x, 1), rays), thick = trial.error(scene(x, 8), rays);
    if (!thin) return {};
    return {*thin, *thick};
  };
  return row;
}

StabilityRow thin_layers() {
  StabilityRow row{.number = 15,
                   .name = "Thin layers",
                   .trigger = "scale height of haze, km",
                   .quantity =
                       "relative error of the optical depth of haze and of a slab of 0.2 "
                       "km; error of order one from 1 deg up",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {0.2, 0.05},
                   .hardest = 0.05};
  row.scene = [](double x) {
    json scene = with(plain_scene(), "aerosol", haze(0.3, 0.9, x, 0.7));
    scene = with(scene, "ozone",
                 {{"type", "absorber"},
                  {"absorption_per_km", 0.5},
                  {"profile", {{"type", "tent"}, {"centre_km", 10}, {"half_width_km", 0.1}}}});
    return changed(sun_at(scene, 20), {{"method", {{"scattering_orders", 1}}}});
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan({90, 40, 10, 3, 1}, {0, 60, 180});
    auto exact = trial.transmittance(scene(x), rays);
    Radiances seen = trial.look(scene(x), rays);
    Measured depth = largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return std::abs(std::log(seen.transmittance[i][c]) / std::log(exact[i][c]) - 1);
    });
    depth.stated = trial.stated(seen);
    return {depth, *trial.error(scene(x), rays)};
  };
  return row;
}

StabilityRow small_planets() {
  StabilityRow row{.number = 16,
                   .name = "Small planets, tall air",
                   .trigger = "radius, km",
                   .quantity =
                       "error of the sky at suns of 30, -5 and -20 deg: 50 km under 20 km "
                       "of air, 400 under 60, 6360 under 1000",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {50, 400, 6360},
                   .hardest = 400};
  row.scene = [](double x) {
    double top = x < 100 ? 20 : x < 1000 ? 60 : 1000, height = top / 10;
    json scene = empty_scene();
    scene["planet"] = {{"radius_km", x}, {"ground_albedo", 0.2}};
    scene["atmosphere"]["thickness_km"] = top;
    scene = with(scene, "gas",
                 {{"type", "molecules"},
                  {"scattering_per_km", power_law(0.1 / height, -4)},
                  {"profile", exponential(height)}});
    return changed(sun_at(scene, -5), {{"camera", {{"pitch_deg", 30}, {"fov_deg", 100}}}});
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    std::vector<Measured> errors;
    for (double sun : {30.0, -5.0, -20.0}) {
      auto error = trial.error(sun_at(scene(x), sun), fan({2, 10, 30, 70}, {5, 60, 120, 175}));
      if (!error) return {};
      errors.push_back(*error);
    }
    return errors;
  };
  return row;
}

/// Nothing; an absorber alone; particles of density 0; molecules alone; particles alone.
json pure(int which) {
  json scene = changed(sun_at(empty_scene(), 35), {{"planet", {{"ground_albedo", 0.3}}}});
  json gas{{"type", "molecules"},
           {"scattering_per_km", power_law(0.0116, -4)},
           {"profile", exponential(8)}};
  json absorber{
      {"type", "absorber"}, {"absorption_per_km", 0.01}, {"profile", {{"type", "uniform"}}}};
  switch (which) {
    case 1:
      return with(scene, "gas", absorber);
    case 2:
      return with(scene, "dust", haze(0, 1, 1.2, 0.7));
    case 3:
      return with(scene, "gas", gas);
    case 4:
      return with(scene, "dust", haze(0.2, 0.9, 1.2, 0.7));
    default:
      return scene;
  }
}

StabilityRow pure_media() {
  StabilityRow row{
      .number = 18,
      .name = "Empty and pure media",
      .trigger =
          "nothing (0), absorber (1), density 0 (2), molecules (3), particles "
          "(4)",
      .quantity =
          "relative difference of order one from its integral in double; "
          "what nothing scatters is 0",
      .bound = 1e-3,
      .stated_errors = 3,  // of one ray; an error is a third of what nearly all are within
      .sweep = {0, 1, 2, 3, 4},
      .hardest = 1};
  row.scene = [](double x) { return pure(static_cast<int>(x)); };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    json scene = changed(pure(static_cast<int>(x)), {{"method", {{"scattering_orders", 1}}}});
    auto rays = fan({90, 20, 2, -2, -30}, {20, 150});
    auto exact = trial.first_order(scene, rays);
    Radiances seen = trial.look(scene, rays);
    Measured gap = largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return apart(seen.radiance[i][c], exact[i][c], noise_of(seen, i, c));
    });
    gap.stated = trial.stated(seen);
    return {gap};
  };
  return row;
}

json extreme(int which) {
  auto air = [](const char* member, double value) {
    return json{{"atmosphere", {{"constituents", {{"air", {{member, value}}}}}}}};
  };
  auto aerosol = [](const json& patch) {
    return json{{"atmosphere", {{"constituents", {{"aerosol", patch}}}}}};
  };
  const json plain = plain_scene();
  switch (which) {
    case 0:
      return changed(plain, air("pressure_pa", 0));
    case 1:
      return changed(plain, air("pressure_pa", 1e8));
    case 2:
    case 3:
      return changed(
          plain,
          aerosol({{"phase",
                    {{"type", "henyey_greenstein"}, {"g", which == 2 ? 0.999 : -0.999}}}}));
    case 4:
      return changed(plain, {{"spectrum", {{"wavelengths_nm", {10, 100, 200}}}}});
    case 5:
      return changed(plain, {{"spectrum", {{"wavelengths_nm", {5000, 2000, 1000}}}}});
    case 6:
    case 7: {
      json profile = exponential(which == 6 ? 0.01 : 1000);
      return changed(
          plain,
          {{"atmosphere",
            {{"constituents",
              {{"air", {{"profile", profile}}}, {"aerosol", {{"profile", profile}}}}}}}});
    }
    case 8:
      return changed(plain, {{"sun", {{"irradiance", 0}}}});
    default:
      return changed(plain, {{"sun", {{"irradiance", 1e9}}}});
  }
}

StabilityRow extremes() {
  StabilityRow row{.number = 24,
                   .name = "Ends of the sliders",
                   .trigger =
                       "pressure 0 and 1000 atm (0, 1), g 0.999 and -0.999 (2, 3), "
                       "wavelengths from 10 and to 5000 nm (4, 5), scale heights 10 m and "
                       "1000 km (6, 7), irradiance 0 and 1e9 (8, 9)",
                   .quantity =
                       "values that are not finite, negative, or above 1 as a "
                       "transmittance",
                   .bound = 0,
                   .sweep = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
                   .hardest = 4};
  row.scene = [](double x) { return extreme(static_cast<int>(x)); };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan({90, 30, 1, 0.01, -0.5, -40}, {0, 90, 180});
    for (double sun : {40.0, -3.0}) trial.look(sun_at(extreme(static_cast<int>(x)), sun), rays);
    return {0};
  };
  return row;
}

StabilityRow pressure() {
  StabilityRow row{.number = 25,
                   .name = "Pressure",
                   .trigger = "pressure, Pa",
                   .quantity =
                       "slope of the log of the optical depth over that of pressure, less "
                       "1, up to ten times the pressure; nothing scatters in a vacuum",
                   .bound = 1e-3,
                   .sweep = {1e2, 1e4, 1e5},
                   .hardest = 1e4};
  row.scene = [](double x) {
    return changed(empty_scene(), {{"atmosphere",
                                    {{"constituents",
                                      {{"air",
                                        {{"type", "molecules"},
                                         {"refractive_index", "air"},
                                         {"pressure_pa", x},
                                         {"temperature_k", 288.15},
                                         {"profile", exponential(8)}}}}}}}});
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    const std::vector<Direction> up{{30, 50}};
    Radiances once = trial.look(scene(x), up), tenfold = trial.look(scene(10 * x), up),
              vacuum = trial.look(scene(0), up);
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      double slope = std::log10(std::log(tenfold.transmittance[0][c]) /
                                std::log(once.transmittance[0][c]));
      worst = std::max(worst, std::abs(slope - 1));
      if (vacuum.radiance[0][c] != 0 || vacuum.transmittance[0][c] != 1)
        throw BrokenFrame("a vacuum scatters");
    }
    return {worst};
  };
  return row;
}

}  // namespace

std::vector<StabilityRow> rows_of_airs() {
  return {coloured_haze(), packed_floats(), forward_peaks(), thin_layers(),
          small_planets(), pure_media(),    extremes(),      pressure()};
}

}  // namespace cyanometer
