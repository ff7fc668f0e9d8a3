#include "engine/scene/presets.h"

#include <algorithm>
#include <map>

#include "engine/embedded.h"
#include "engine/scene/reading.h"
#include "engine/scene/spelling.h"

namespace cyanometer {
namespace {

constexpr std::string_view extension = ".json";

struct Stored {
  Preset preset;
  Json file;
};

Stored load(const EmbeddedFile& file) {
  try {
    const std::string name(file.path.substr(0, file.path.size() - extension.size()));
    Json content = parse_json(file.bytes);
    return {{name, content.at("title"), content.at("source")}, std::move(content)};
  } catch (const std::exception& problem) {
    throw std::logic_error("preset " + std::string(file.path) + ": " + problem.what());
  }
}

const std::vector<Stored>& all() {
  static const std::vector<Stored> stored = [] {
    std::vector<Stored> loaded;
    for (const EmbeddedFile& file : preset_files())
      if (file.path.ends_with(extension)) loaded.push_back(load(file));
    std::ranges::sort(loaded, {}, [](const Stored& one) {
      return std::pair(one.file.value("order", 0), one.preset.name);
    });
    return loaded;
  }();
  return stored;
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const Stored& one : all()) names.push_back(one.preset.name);
  return names;
}

Json over(const Json& base, const Json& document) {
  Json own = document;
  own.erase("preset");
  return merge(base, own);
}

/// The presets that a preset starts from are expanded before it; `depth` stops at a circle.
Json expand(std::string_view name, std::size_t depth) {
  if (depth > all().size())
    throw std::logic_error("preset " + std::string(name) + " starts from itself");
  const Json& own = preset_document(name);
  if (name == base_preset) return over(Json::object(), own);
  return over(expand(own.value("preset", std::string(base_preset)), depth + 1), own);
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list = [] {
    std::vector<Preset> presets;
    for (const Stored& one : all()) presets.push_back(one.preset);
    return presets;
  }();
  return list;
}

const Json& preset_document(std::string_view name) {
  for (const Stored& one : all())
    if (one.preset.name == name) return one.file.at("scene");
  throw std::out_of_range("there is no preset " + std::string(name));
}

const Json& expanded_preset(std::string_view name) {
  static const std::map<std::string, Json, std::less<>> expanded = [] {
    std::map<std::string, Json, std::less<>> result;
    for (const std::string& one : names()) result[one] = expand(one, 0);
    return result;
  }();
  return expanded.at(std::string(name));
}

Json expanded(const Json& document) {
  Reading reading;
  const At root{reading, ""};
  if (!document.is_object()) refuse(root, document, "an object");
  const Json* preset = given_member(document, "preset");
  if (preset) check_name(*preset, names(), root / "preset");
  return over(expanded_preset(preset ? preset->get<std::string>() : std::string(base_preset)),
              document);
}

Json expanded(const Json& document, const Json& patch) {
  const auto preset = patch.find("preset");
  if (preset == patch.end() || !document.is_object()) return over(expanded(document), patch);
  Json other = document;
  other["preset"] = *preset;
  return over(expanded(other), patch);
}

}  // namespace cyanometer
