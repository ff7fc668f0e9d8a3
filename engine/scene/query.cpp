#include "engine/scene/reading.h"

namespace cyanometer {
namespace {

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos;
       dot = path.find('.', begin)) {
    parts.push_back(path.substr(begin, dot - begin));
    begin = dot + 1;
  }
  parts.push_back(path.substr(begin));
  return parts;
}

/// What the link says must be UTF-8, like all of a document.
void check_utf8(const std::string& text, const std::string& pointer) {
  try {
    static_cast<void>(Json(text).dump());
  } catch (const Json::type_error&) {
    throw SceneError(pointer, quote(text), "text in UTF-8",
                     "The link says " + quote(text) + ", which is not UTF-8.");
  }
}

Json value_of(const std::string& text, const std::string& pointer) {
  try {
    return parse_json(text);
  } catch (const SceneError&) {
    check_utf8(text, pointer);
    return text;
  }
}

void set(Json& document, const std::string& path, const std::string& value) {
  constexpr std::size_t deepest = 16;
  check_utf8(path, "");
  const auto parts = parts_of(path);
  if (parts.size() > deepest)
    throw SceneError("", quote(path), "a path of at most " + std::to_string(deepest) + " names",
                     "The path " + quote(path) + " has too many parts.");
  Json* object = &document;
  std::string pointer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    if (parts[i].empty())
      throw SceneError(pointer, quote(path), "names with single dots between them",
                       "The path " + quote(path) + " has an empty part.");
    if (!object->is_object())
      throw SceneError(pointer, quote(*object), "an object",
                       pointer + " is given a value and members.");
    pointer = pointer_to(pointer, parts[i]);
    const bool there = object->contains(parts[i]);
    if (last && there)
      throw SceneError(pointer, quote(value), "given once", pointer + " is given twice.");
    Json& member = (*object)[parts[i]];
    if (last)
      member = value_of(value, pointer);
    else if (!there)
      member = Json::object();
    object = &member;
  }
}

}  // namespace

Json document_from_query(const std::vector<std::pair<std::string, std::string>>& query) {
  Json document = Json::object();
  for (const auto& [path, value] : query) set(document, path, value);
  return document;
}

}  // namespace cyanometer
