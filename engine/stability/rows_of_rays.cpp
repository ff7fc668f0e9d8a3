// Rows about where rays go: horizons, limbs, short and long paths.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/document.h"
#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;
constexpr double radius_km = 6360;

json seen_from(json scene, double altitude_km, double sun_deg) {
  return changed(std::move(scene), {{"camera", {{"altitude_km", altitude_km}}},
                                    {"sun", {{"elevation_deg", sun_deg}}}});
}

/// Elevation of the ground's horizon; exact next to the ground too.
double horizon_deg(double altitude_km, double radius = radius_km) {
  return -std::atan2(std::sqrt(altitude_km * (2 * radius + altitude_km)), radius) / degree;
}

/// Largest jump from row to row of the ratio to a solution that is smooth there.
Measured largest_jump(Trial& trial, const json& scene, const std::vector<Direction>& rows) {
  Radiances seen = trial.look(scene, rows);
  auto smooth = trial.smooth_truth(scene, rows);
  return largest(rows.size() - 1, [&](std::size_t i, std::size_t c) {
    double here = seen.radiance[i][c] / smooth[i][c],
           next = seen.radiance[i + 1][c] / smooth[i + 1][c];
    return apart(here, next,
                 together({noise_of(seen, i, c) / smooth[i][c],
                           noise_of(seen, i + 1, c) / smooth[i + 1][c]}));
  });
}

StabilityRow horizon_seam() {
  StabilityRow row{.number = 1,
                   .name = "Horizon seam",
                   .trigger = "camera's altitude, km",
                   .quantity =
                       "largest relative jump between rows 0.004 deg apart next to the "
                       "horizon, of the ratio to the converged solution",
                   .bound = 0.005,
                   .sweep = {0, 0.001, 0.002, 0.005, 0.01},
                   .hardest = 0.002};
  row.scene = [](double x) { return seen_from(plain_scene(), x, 3); };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    std::vector<Measured> jumps;
    for (double sun : {3.0, 30.0}) {
      json scene = seen_from(plain_scene(), x, sun);
      double horizon = horizon_deg(x);
      auto above = fan(spaced(horizon + 0.002, horizon + 0.1, 25), {30});
      auto below = fan(spaced(horizon - 0.002, horizon - 0.1, 25), {30});
      jumps.push_back(largest_jump(trial, scene, above));
      jumps.push_back(largest_jump(trial, scene, below));
    }
    return jumps;
  };
  return row;
}

StabilityRow short_paths() {
  StabilityRow row{
      .number = 2,
      .name = "Short paths",
      .trigger = "distance of black ground, km",
      .quantity = "error of the light of the air before it, the sun at the horizon",
      .bound = 0.02,
      .stated_errors = 1,
      .sweep = {0.001, 0.01, 0.1, 1},
      .hardest = 0.001};
  row.scene = [](double x) {
    return seen_from(changed(plain_scene(), {{"planet", {{"ground_albedo", 0}}},
                                             {"camera", {{"pitch_deg", -40}}}}),
                     x, 0.5);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    return measured(trial.error(scene(x), fan({-90, -60, -40, -30}, {10, 100, 170})));
  };
  return row;
}

/// Distance to the ground in this direction; without cancellation.
double distance_to_ground(double altitude_km, double elevation_deg) {
  double r_mu = (radius_km + altitude_km) * std::sin(elevation_deg * degree);
  double c = altitude_km * (2 * radius_km + altitude_km);
  return c / (-r_mu + std::sqrt(r_mu * r_mu - c));
}

StabilityRow horizon_distance() {
  StabilityRow row{.number = 4,
                   .name = "Cancellation at the horizon",
                   .trigger = "camera's altitude, km",
                   .quantity =
                       "relative error of the distance to ground down to 0.001 deg below "
                       "the horizon, from the transmittance of an even absorber",
                   .bound = 1e-3,
                   .sweep = {0.001, 0.002, 0.005, 0.01},
                   .hardest = 0.001};
  row.scene = [](double x) {
    return seen_from(changed(empty_scene(), {{"planet", {{"ground_albedo", 0.3}}},
                                             {"atmosphere",
                                              {{"constituents",
                                                {{"gas",
                                                  {{"type", "absorber"},
                                                   {"absorption_per_km", 0.02},
                                                   {"profile", {{"type", "uniform"}}}}}}}}}}),
                     x, 30);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan({horizon_deg(x) - 0.001, horizon_deg(x) - 0.004, horizon_deg(x) - 0.02,
                     horizon_deg(x) - 0.1},
                    {0, 70});
    Radiances seen = trial.look(scene(x), rays);
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      double exact = distance_to_ground(x, rays[i].elevation_deg);
      return std::abs(-std::log(seen.transmittance[i][c]) / 0.02 / exact - 1);
    })};
  };
  return row;
}

/// How much the picture changes between two altitudes that nobody can tell apart.
Measured altitude_step(Trial& trial, const json& scene, double low_km, double high_km,
                       const std::vector<Direction>& rays) {
  Radiances a = trial.look(seen_from(scene, low_km, 20), rays),
            b = trial.look(seen_from(scene, high_km, 20), rays);
  auto of_a = [&](std::size_t i, std::size_t c) { return a.radiance[i][c]; };
  const double brightest = largest(rays.size(), of_a).value;
  return largest(rays.size(), [&](std::size_t i, std::size_t c) -> Measured {
    double noise = together({noise_of(a, i, c), noise_of(b, i, c)});
    double change = std::max(std::abs(a.radiance[i][c] - b.radiance[i][c]) - noise, 0.0);
    double scale = a.radiance[i][c] + 1e-3 * brightest;
    return {change / scale, noise / scale};
  });
}

StabilityRow altitude_limits() {
  StabilityRow row{.number = 5,
                   .name = "Altitudes at the limits",
                   .trigger = "camera's altitude, km",
                   .quantity =
                       "relative change over one step of the number (ground, top), over "
                       "1 m (deep space); below ground is refused",
                   .bound = 1e-3,
                   .sweep = {0, 100, 1e6},
                   .hardest = 0};
  row.scene = [](double x) {
    return seen_from(
        changed(plain_scene(),
                {{"camera", {{"pitch_deg", x > 0 ? -90 : 10}, {"fov_deg", x > 1e3 ? 1 : 90}}}}),
        x, 20);
  };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    json scene = plain_scene();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (x == 0) {
      try {
        read_scene(seen_from(scene, -1e-9, 20));
        throw BrokenFrame("a camera below ground was not refused");
      } catch (const SceneError&) {
      }
      auto rays = fan({90, 45, 5, 0.5, -5, -90}, {0, 120});
      return {altitude_step(trial, scene, 0, std::nextafter(0.0, 1.0), rays),
              altitude_step(trial, scene, 0, 1e-9, rays)};
    }
    if (x == 100) {
      auto rays = fan({45, -4, -12, -30, -90}, {0, 120});
      return {altitude_step(trial, scene, std::nextafter(100, 0.0), 100, rays),
              altitude_step(trial, scene, 100, std::nextafter(100, infinite), rays)};
    }
    double limb = std::asin((radius_km + 100) / (radius_km + x)) / degree;
    auto rays = fan({-90, -90 + 0.5 * limb, -90 + 0.9 * limb, -90 + 0.97 * limb}, {0, 120});
    return {altitude_step(trial, scene, x - 1e-3, x, rays)};
  };
  return row;
}

StabilityRow faint_light() {
  StabilityRow row{.number = 6,
                   .name = "Faint transmittances",
                   .trigger = "scattering of the air over the Earth's",
                   .quantity = "relative error of the optical depth, up to 80",
                   .bound = 1e-3,
                   .sweep = {1, 3, 8},
                   .hardest = 8};
  row.scene = [](double x) {
    return seen_from(
        changed(
            plain_scene(),
            {{"atmosphere",
              {{"constituents",
                {{"air",
                  {{"type", "molecules"},
                   {"scattering_per_km",
                    {{"power_law", {{"value", 0.0116 * x}, {"at_nm", 550}, {"exponent", -4}}}}},
                   {"profile", {{"type", "exponential"}, {"scale_height_km", 8}}}}}}}}}}),
        0.002, 5);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan({0.02, 0.5, 1, 2, 5, 20, 90}, {40});
    auto exact = trial.transmittance(scene(x), rays);
    Radiances seen = trial.look(scene(x), rays);
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      double depth = -std::log(exact[i][c]);
      return depth > 80 ? 0 : std::abs(-std::log(seen.transmittance[i][c]) / depth - 1);
    })};
  };
  return row;
}

StabilityRow degenerate_directions() {
  StabilityRow row{.number = 19,
                   .name = "Degenerate directions",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "relative change when sun or view turn by 1e-6 deg about the "
                       "vertical, or by any angle in it",
                   .bound = 1e-3,
                   .sweep = {90, 30},
                   .hardest = 90};
  row.scene = [](double x) {
    return seen_from(changed(plain_scene(), {{"camera", {{"pitch_deg", 90}}}}), 0.002, x);
  };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    json scene = seen_from(plain_scene(), 0.002, x);
    json turned = changed(
        scene, {{"sun", {{"elevation_deg", x - 1e-6}, {"azimuth_deg", x == 90 ? 123 : 0}}}});
    auto rays = fan({90, -90, 60, 10}, {0});
    auto moved = fan({90 - 1e-6, -90 + 1e-6, 60, 10}, {0});
    for (std::size_t i = 0; i < 2; ++i) moved[i].azimuth_deg = 77;
    Radiances a = trial.look(scene, rays), b = trial.look(turned, moved);
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return apart(a.radiance[i][c], b.radiance[i][c],
                   together({noise_of(a, i, c), noise_of(b, i, c)}));
    })};
  };
  return row;
}

StabilityRow long_views() {
  StabilityRow row{.number = 20,
                   .name = "Long views of the ground",
                   .trigger = "camera's altitude, km",
                   .quantity =
                       "error of the transmittance to ground, up to 0.999 of the way to "
                       "the horizon",
                   .bound = 1e-3,
                   .sweep = {10, 100, 1000, 36000},
                   .hardest = 36000};
  row.scene = [](double x) {
    return seen_from(changed(plain_scene(), {{"camera", {{"pitch_deg", -90}}}}), x, 40);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    double from_nadir = 90 + horizon_deg(x);
    std::vector<double> elevations;
    for (double share : {0.0, 0.4, 0.8, 0.95, 0.99, 0.999})
      elevations.push_back(-90 + share * from_nadir);
    auto rays = fan(elevations, {0, 130});
    auto exact = trial.transmittance(scene(x), rays);
    Radiances seen = trial.look(scene(x), rays);
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return std::abs(seen.transmittance[i][c] - exact[i][c]);
    })};
  };
  return row;
}

StabilityRow limb() {
  StabilityRow row{.number = 21,
                   .name = "Limb",
                   .trigger = "camera's altitude, km",
                   .quantity = "error along tangent rays at 2 to 98 km",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {101, 400, 36000},
                   .hardest = 400};
  row.scene = [](double x) {
    return seen_from(
        changed(plain_scene(), {{"camera", {{"pitch_deg", horizon_deg(x)}, {"fov_deg", 10}}}}),
        x, 30);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    std::vector<double> elevations;
    for (double tangent_km : spaced(2, 98, 17))
      elevations.push_back(-std::acos((radius_km + tangent_km) / (radius_km + x)) / degree);
    return measured(trial.error(scene(x), fan(elevations, {20, 110})));
  };
  return row;
}

}  // namespace

std::vector<StabilityRow> rows_of_rays() {
  return {horizon_seam(), short_paths(),           horizon_distance(), altitude_limits(),
          faint_light(),  degenerate_directions(), long_views(),       limb()};
}

}  // namespace cyanometer
