// What is left out of the air: orders, its upper part, the shape of its profile.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/accuracy/comparison.h"
#include "engine/accuracy/error.h"
#include "engine/experiments/experiments.h"
#include "engine/experiments/measured.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

constexpr const char* skies[] = {"earth_noon", "earth_low_sun", "earth_twilight", "earth_hazy"};

/// Mean over rays that are lit of how much the weakest wavelength lacks to the strongest: 0 is
/// white.
double saturation(const RayValues& values) {
  double sum = 0, count = 0;
  for (const auto& ray : values) {
    const auto [least, most] = std::ranges::minmax(ray);
    if (most <= 0) continue;
    sum += 1 - least / most;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

Finding orders_kept(Engine& engine, const ExperimentSettings& settings, const Watch& watch) {
  constexpr int kept[] = {1, 2, 3, 4, 6, 8};
  std::string head = "| orders kept |", rule = "|---|";
  std::map<int, std::string> rows;
  for (const char* sky : skies) {
    head += " `" + std::string(sky) + "` |";
    rule += "---|";
    Scene scene = scene_of_preset(sky, json::object(), settings.pixels);
    const std::vector<Direction> directions = sample_directions(scene, settings.rays);
    const RayValues all = finest_of(engine, scene, directions, watch);
    for (int orders : kept) {
      scene.method.scattering_orders = orders;
      const RayValues first = finest_of(engine, scene, directions, watch);
      rows[orders] += " " + percent(measure_error(first, all).error) + " |";
    }
  }
  std::string out = head + "\n" + rule + "\n";
  for (const auto& [orders, row] : rows)
    out += "| " + std::to_string(orders) + " |" + row + "\n";
  return {out, {}};
}

Finding heights_of_the_top(Engine& engine, const ExperimentSettings& settings,
                           const Watch& watch) {
  constexpr double highest_km = 300;
  const auto scene_under = [&](double top_km) {
    return scene_of_preset("thesis_defaults",
                           {{"atmosphere", {{"thickness_km", top_km}}},
                            {"camera", {{"altitude_km", 12000}, {"pitch_deg", -72}}},
                            {"sun", {{"elevation_deg", 40}}},
                            {"method", {{"scattering_orders", 1}}}},
                           settings.pixels);
  };
  // The same rays under all tops.
  const Scene highest = scene_under(highest_km);
  const std::vector<Direction> directions = sample_directions(scene_under(60), settings.rays);
  const RayValues truth = finest_of(engine, highest, directions, watch);
  std::string out =
      "| top of the air, km | error of the air above left out | error of 16 x 8 samples | "
      "saturation | of 16 x 8 samples |\n|---|---|---|---|---|\n";
  for (double top_km : {10.0, 20.0, 40.0, 60.0, 80.0, 120.0, 200.0, 300.0}) {
    const Scene scene = scene_under(top_km);
    const RayValues converged = finest_of(engine, scene, directions, watch);
    const RayValues coarse = seen_by(engine, scene, directions, "nishita",
                                     {{"view_samples", 16}, {"light_samples", 8}}, watch);
    out += "| " + std::to_string(int(top_km)) + " | " +
           percent(measure_error(converged, truth).error) + " | " +
           percent(measure_error(coarse, converged).error) + " | " +
           percent(saturation(converged)) + " | " + percent(saturation(coarse)) + " |\n";
  }
  return {out, {}};
}

Finding quadratic_air(Engine& engine, const ExperimentSettings& settings, const Watch& watch) {
  std::string out = "| sun | error | CIEDE2000, 99 % |\n|---|---|---|\n";
  for (double sun : {60.0, 20.0, 2.0, -4.0}) {
    const auto scene_of = [&](const char* preset) {
      Scene scene = scene_of_preset(preset,
                                    {{"sun", {{"elevation_deg", sun}}},
                                     {"camera", {{"altitude_km", 0.002}, {"pitch_deg", 15}}},
                                     {"image", {{"exposure_ev", "auto"}}}},
                                    std::min(settings.pixels, 14400));
      const Plan finest = plan_by(scene, "moments", {});
      scene.method.name = finest.method;
      scene.method.options = finest.options;
      return scene;
    };
    const Comparison difference = compare(render_pair(engine, scene_of("planet_quadratic"),
                                                      scene_of("planet_exponential"), watch),
                                          watch);
    char colours[32];
    std::snprintf(colours, sizeof colours, "%.2g", difference.ciede2000_p99);
    out += "| " + degrees(sun) + " | " + percent(difference.measure.error) + " | " + colours +
           " |\n";
  }
  return {out, {}};
}

}  // namespace cyanometer
