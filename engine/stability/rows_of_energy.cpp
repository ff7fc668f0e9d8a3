// Rows about what becomes of the light: nothing that is not absorbed may be lost.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// So large that its air is plane, over white ground; nothing absorbs.
json flat_white(const char* name, const json& constituent, double sun_deg) {
  return changed(empty_scene(), {{"planet", {{"radius_km", 1e6}, {"ground_albedo", 1}}},
                                 {"sun", {{"elevation_deg", sun_deg}}},
                                 {"atmosphere", {{"constituents", {{name, constituent}}}}}});
}

json molecules(double optical_depth) {
  return {{"type", "molecules"},
          {"scattering_per_km",
           {{"power_law", {{"value", optical_depth / 8}, {"at_nm", 550}, {"exponent", -4}}}}},
          {"profile", {{"type", "exponential"}, {"scale_height_km", 8}}}};
}

json peaked(double g) {
  return {{"type", "particles"},
          {"optical_depth", 1},
          {"single_scattering_albedo", 1},
          {"profile", {{"type", "exponential"}, {"scale_height_km", 2}}},
          {"phase", {{"type", "henyey_greenstein"}, {"g", g}}}};
}

/// What goes down less what goes up, over what came from the sun, by channel.
std::array<double, 3> net_fluxes(const Radiances& seen, double sun_deg) {
  double incident = std::sin(sun_deg * degree);
  std::array<double, 3> net{};
  for (std::size_t c = 0; c < 3; ++c) {
    net[c] = (seen.irradiance->direct[c] + seen.irradiance->diffuse_down[c] -
              seen.irradiance->diffuse_up[c]) /
             incident;
  }
  return net;
}

/// The largest of them, 0 where nothing absorbs; of random walks what eight runs say beyond
/// four standard errors of their mean.
Measured net_flux(Trial& trial, const json& scene, double sun_deg) {
  const int runs = trial.is_reference() ? 8 : 1;
  std::array<double, 3> sum{}, squares{};
  double stated = 0;
  for (int run = 0; run < runs; ++run) {
    json seeded = scene;
    if (runs > 1) seeded["method"]["seed"] = run;
    Radiances seen = trial.look(seeded, {{90, 0}, {-90, 0}}, true);
    stated = trial.stated(seen);
    std::array<double, 3> net = net_fluxes(seen, sun_deg);
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += net[c];
      squares[c] += net[c] * net[c];
    }
  }
  Measured worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = sum[c] / runs, variance = std::max(squares[c] / runs - mean * mean, 0.0);
    double noise = runs > 1 ? 4 * std::sqrt(variance / (runs - 1)) : 0;
    worst = larger(worst, {std::max(std::abs(mean) - noise, 0.0), noise});
  }
  worst.stated = stated;
  return worst;
}

StabilityRow series_of_orders() {
  StabilityRow row{.number = 12,
                   .name = "Multiple scattering without end",
                   .trigger = "optical depth at 550 nm",
                   .quantity =
                       "net flux over white ground where nothing absorbs, over that of "
                       "the sun",
                   .bound = 0.01,
                   .many_orders = true,
                   .stated_errors = 2,
                   .sweep = {0.1, 1, 3, 10},
                   .hardest = 1};
  row.scene = [](double x) { return flat_white("gas", molecules(x), 60); };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    json high = changed(scene(x), {{"camera", {{"altitude_km", 8}}}});
    return {net_flux(trial, scene(x), 60), net_flux(trial, high, 60)};
  };
  return row;
}

StabilityRow angular_grids() {
  StabilityRow row{.number = 14,
                   .name = "Peaks on coarse grids",
                   .trigger = "g",
                   .quantity =
                       "net flux over white ground under haze of optical depth 1 that "
                       "does not absorb, over that of the sun",
                   .bound = 0.01,
                   .many_orders = true,
                   .stated_errors = 2,
                   .sweep = {0.9, 0.95, 0.99},
                   .hardest = 0.95};
  row.scene = [](double x) { return flat_white("haze", peaked(x), 50); };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    return {net_flux(trial, scene(x), 50)};
  };
  return row;
}

/// R(a to b) sin(b) = R(b to a) sin(a): light goes either way [Chandrasekhar 1960, section 13].
Measured reciprocity_gap(Trial& trial, const json& scene, double a_deg, double b_deg) {
  auto reflected = [&](double sun_deg, double view_deg) {
    json lit = changed(
        scene, {{"sun", {{"elevation_deg", sun_deg}}}, {"camera", {{"altitude_km", 100}}}});
    return trial.look(lit, {{-view_deg, 70}});
  };
  Radiances there = reflected(a_deg, b_deg), back = reflected(b_deg, a_deg);
  double sin_a = std::sin(a_deg * degree), sin_b = std::sin(b_deg * degree);
  Measured gap = largest(1, [&](std::size_t i, std::size_t c) {
    return apart(there.radiance[i][c] / sin_a, back.radiance[i][c] / sin_b,
                 together({noise_of(there, i, c) / sin_a, noise_of(back, i, c) / sin_b}));
  });
  gap.stated = std::max(trial.stated(there), trial.stated(back));
  return gap;
}

StabilityRow energy() {
  StabilityRow row{.number = 22,
                   .name = "Energy and reciprocity",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "light out of the top over light in, less 1, and the relative "
                       "difference when sun and view change places; white ground, nothing "
                       "absorbs",
                   .bound = 0.01,
                   .stated_errors = 2,
                   .sweep = {60, 20, 8},
                   .hardest = 20};
  row.scene = [](double x) { return flat_white("gas", molecules(0.3), x); };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    Measured gap = reciprocity_gap(trial, scene(x), x, 45);
    if (trial.first_order_only()) return {gap};
    json high = changed(scene(x), {{"camera", {{"altitude_km", 100}}}});
    return {gap, net_flux(trial, high, x)};
  };
  return row;
}

}  // namespace

std::vector<StabilityRow> rows_of_energy() {
  return {series_of_orders(), angular_grids(), energy()};
}

}  // namespace cyanometer
