// What experiments measure with: light along rays of a scene.
#pragma once

#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

using RayValues = std::vector<std::vector<double>>;

/// The preset as it is charted (accuracy/chart.h), changed by a merge patch.
Scene scene_of_preset(const std::string& preset, const nlohmann::json& patch, int pixels);

Plan plan_by(const Scene& scene, const std::string& method,
             const std::map<std::string, double>& options);

/// By the method's defaults and these options.
RayValues seen_by(Engine& engine, const Scene& scene, const std::vector<Direction>& directions,
                  const std::string& method, const std::map<std::string, double>& options,
                  const Watch& watch);

/// The finest solution without random numbers.
RayValues finest_of(Engine& engine, const Scene& scene,
                    const std::vector<Direction>& directions, const Watch& watch);

/// "12 %", "0.034 %".
std::string percent(double share);
/// "60°".
std::string degrees(double angle_deg);

}  // namespace cyanometer
