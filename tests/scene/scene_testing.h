// Short forms for tests of the scene document.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "engine/scene/document.h"

namespace cyanometer {

using Json = nlohmann::json;

/// How a test that fails shows a scene.
inline void PrintTo(const Scene& scene, std::ostream* out) { *out << canonical(scene); }

inline Scene scene_of(const std::string& text) { return read_scene(parse_json(text)); }

/// The refusal of a document; none where it is accepted.
inline std::optional<SceneError> refusal(const Json& document) {
  try {
    read_scene(document);
    return std::nullopt;
  } catch (const SceneError& error) {
    return error;
  }
}
inline std::string refused_at(const std::string& text) {
  const auto error = refusal(parse_json(text));
  return error ? error->pointer : "accepted";
}

/// A document with one member set.
inline Json with(const std::string& pointer, const Json& value) {
  Json document = Json::object();
  document[Json::json_pointer(pointer)] = value;
  return document;
}

}  // namespace cyanometer
