// The documents that HTTP and the command line answer alike.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "engine/accuracy/attribution.h"
#include "engine/accuracy/comparison.h"
#include "engine/accuracy/ingredients.h"
#include "engine/engine.h"

namespace cyanometer {

/// The answer of /v1/plan.
nlohmann::json plan_document(const Scene& scene, const Plan& plan);

/// The body of /v1/radiance, read.
struct RadianceRequest {
  Scene scene;
  std::vector<Direction> directions;
  bool irradiance = false;
};
constexpr std::size_t most_directions = 4096;
/// @throws SceneError with pointers into the body, OverLimit for too many directions
RadianceRequest read_radiance_request(const nlohmann::json& document);

/// The answer of /v1/radiance for a scene.
nlohmann::json radiance_document(const Scene& scene, const Radiances& radiances);

/// The body of /v1/compare, read: scenes that can be compared.
struct CompareRequest {
  Scene a, b;
};
/// @throws SceneError with pointers into the body
CompareRequest read_compare_request(const nlohmann::json& document);

/// Their frames. @throws SceneError, OverLimit, with pointers into the body, and as render_pair
FramePair render_pair(Engine& engine, const CompareRequest& asked, const Watch& watch);

/// The answer of /v1/compare.
nlohmann::json comparison_document(const Comparison& comparison);

/// The answer of /v1/explain.
nlohmann::json explanation_document(const std::vector<Worth>& ingredients);
/// {"method", "options", "wavelengths_nm", "error", "error_95", "reference_noise", "shares":
/// [{"cause", "error", "how"}]}
nlohmann::json attribution_document(const Attribution& attribution);

}  // namespace cyanometer
