// Presets as documents on top of which others are merged. Internal to engine/scene.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace cyanometer {

/// From which every document starts that names no other.
inline constexpr std::string_view base_preset = "earth";

/// The preset merged over those that it starts from, down to `earth`; it has no `preset`
/// itself.
const nlohmann::json& expanded_preset(std::string_view name);

/// The document merged over its preset.
/// @throws SceneError where it is no object or names no preset
nlohmann::json expanded(const nlohmann::json& document);
/// The same, and the patch over it; a preset that the patch names stands for the document's.
nlohmann::json expanded(const nlohmann::json& document, const nlohmann::json& patch);

}  // namespace cyanometer
