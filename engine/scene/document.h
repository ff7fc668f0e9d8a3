// The scene document: JSON to Scene and back, with presets, validation and the JSON Schema, all
// from one description of the members (`members.h`).
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

/// A document that is refused: where, what was given, what is allowed.
struct SceneError : std::runtime_error {
  SceneError(std::string pointer_, std::string given_, std::string allowed_,
             std::string what_is_wrong);
  std::string pointer;  ///< RFC 6901, "" for the whole document
  std::string given;    ///< the value as JSON, shortened; "" where it is missing
  std::string allowed;  ///< in words: "a number from 1 to 1e7"
};

/// The longest text that is parsed.
inline constexpr std::size_t most_json_bytes = std::size_t{8} << 20;

/// Parses bytes as strict UTF-8 JSON: no duplicate keys, bounded depth and size, finite
/// numbers.
/// @throws SceneError with pointer "" (or that of the duplicate key)
nlohmann::json parse_json(std::string_view bytes);

/// Merges `document` over its preset, validates it and resolves every default.
/// @throws SceneError
Scene read_scene(const nlohmann::json& document);
/// The same of a document and a merge patch, an object, which is merged over all that the
/// document says together with its preset: a part may leave its type to the preset. A preset
/// that the patch names stands for the document's.
/// @throws SceneError
Scene read_scene(const nlohmann::json& document, const nlohmann::json& patch);

/// The document that a link's query says: dotted paths set members, values are JSON where they
/// parse, else strings.
/// @throws SceneError where a path is given twice, has an empty part, or leads through no
/// object
nlohmann::json document_from_query(
    const std::vector<std::pair<std::string, std::string>>& query);

/// The whole scene as a document that reads back as the same scene: every member that is not
/// idle, none that is, no preset. Equal scenes have equal bytes (`dump()` of this).
nlohmann::json canonical(const Scene& scene);

/// RFC 7396 with the contract's additions (spectra, lists and objects of another `type` are
/// replaced whole, an alternative form drops the inherited one, null restores a default). Of a
/// part whose type only a preset would tell it knows no forms.
nlohmann::json merge(const nlohmann::json& document, const nlohmann::json& patch);

/// JSON Schema (2020-12) of the document, with titles, units, ranges, defaults and slider
/// hints.
nlohmann::json scene_schema();

struct Preset {
  std::string name;    ///< as in the document's `preset`
  std::string title;   ///< for people
  std::string source;  ///< where its numbers come from
};
/// All presets, in the order in which they are shown.
const std::vector<Preset>& presets();
/// The preset's own document, as stored.
const nlohmann::json& preset_document(std::string_view name);

}  // namespace cyanometer
