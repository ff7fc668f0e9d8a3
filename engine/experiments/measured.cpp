#include "engine/experiments/measured.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/accuracy/chart.h"
#include "engine/accuracy/finest.h"
#include "engine/scene/document.h"

namespace cyanometer {

Scene scene_of_preset(const std::string& preset, const nlohmann::json& patch, int pixels) {
  nlohmann::json document{{"preset", preset}};
  document.update(patch, true);
  return charted(read_scene(document), pixels);
}

Plan plan_by(const Scene& scene, const std::string& method,
             const std::map<std::string, double>& options) {
  Plan plan;
  plan.method = method;
  plan.options = defaults_of(*std::ranges::find(methods(), method, &MethodDescription::name));
  for (const auto& [name, value] : options) plan.options.at(name) = value;
  plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
  return plan;
}

RayValues seen_by(Engine& engine, const Scene& scene, const std::vector<Direction>& directions,
                  const std::string& method, const std::map<std::string, double>& options,
                  const Watch& watch) {
  return engine.radiance(scene, directions, false, plan_by(scene, method, options), watch)
      .radiance;
}

RayValues finest_of(Engine& engine, const Scene& scene,
                    const std::vector<Direction>& directions, const Watch& watch) {
  const Plan plan = finest_plan(scene, scene.spectrum.wavelengths_nm);
  return engine.radiance(scene, directions, false, plan, watch).radiance;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

std::string degrees(double angle_deg) {
  char text[32];
  std::snprintf(text, sizeof text, "%g°", angle_deg);
  return text;
}

}  // namespace cyanometer
