#include "server/commands/image_file.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

const Encoding* encoding_of_extension(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const auto& each : encodings()) {
    if (std::ranges::find(each.extensions, extension) != each.extensions.end()) return &each;
  }
  return nullptr;
}

bool names_format(const nlohmann::json& document) {
  return document.is_object() && document.contains("image") && document["image"].is_object() &&
         document["image"].contains("format");
}

}  // namespace

Scene scene_for_file(nlohmann::json document, const std::string& path) {
  const Encoding* wanted = encoding_of_extension(path);
  if (!wanted && path != "-") {
    throw CommandError(exit_refused, path + " has no extension of a format that is known here");
  }
  if (wanted && !names_format(document)) {
    document = merge(document, {{"image", {{"format", wanted->name}}}});
  }
  Scene scene = read_scene(document);
  if (wanted && scene.image.format != wanted->format) {
    throw CommandError(exit_refused, "the scene asks for " +
                                         std::string(encoding(scene.image.format).name) + ", " +
                                         path + " for " + std::string(wanted->name));
  }
  return scene;
}

}  // namespace cyanometer
