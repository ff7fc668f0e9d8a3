// What the readers of a document share: where they are, what has been read, and how they
// refuse. Internal to engine/scene.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/document.h"

namespace cyanometer {

using Json = nlohmann::json;

/// A moment at a point of the Earth: the other way to say where the sun stands.
struct Place {
  double latitude_deg = 0;
  double longitude_deg = 0;
  std::string time;  ///< RFC 3339 with its offset
};

/// What has been read so far; parts are read in the order of `scene_members()`, so that a
/// default or a rule may look at every part before its own.
struct Reading {
  Scene scene;
  std::optional<Place> place;
};

/// A point of the document that is being read.
struct At {
  Reading& reading;
  std::string pointer;  ///< RFC 6901

  At operator/(std::string_view member) const;
  At operator/(std::size_t index) const;
};

/// The value as JSON, shortened, in ASCII.
std::string quote(const Json& given);

/// @throws SceneError: `given` is not `allowed` here, and why where that does not say it
[[noreturn]] void refuse(const At& at, const Json& given, const std::string& allowed,
                         const std::string& why = "");
[[noreturn]] void refuse_missing(const At& at, const std::string& allowed);

/// RFC 6901: the pointer to a member of what `pointer` points to.
std::string pointer_to(std::string_view pointer, std::string_view member);

/// As people write it: "1e7", "0.002".
std::string in_words(double number);
/// " from 0 to 1e6".
std::string range_in_words(double minimum, double maximum);
/// "a, b or c".
std::string in_words(const std::vector<std::string>& items, std::string_view last = " or ");

/// The number as the canonical form has it: whole ones as integers, no negative zero.
Json canonical_number(double number);

/// Null where the member is absent or null, which says the same: the default.
const Json* given_member(const Json& object, std::string_view name);

}  // namespace cyanometer
