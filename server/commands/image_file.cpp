#include "server/commands/image_file.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

const Encoding* encoding_of_extension(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const auto& each : encodings()) {
    if (std::ranges::find(each.extensions, extension) != each.extensions.end()) return &each;
  }
  return nullptr;
}

}  // namespace

nlohmann::json document_for_file(const nlohmann::json& document, const std::string& path) {
  const Encoding* wanted = encoding_of_extension(path);
  if (wanted) return with_usual_format(document, wanted->name);
  if (path == "-") return document;
  throw CommandError(exit_refused, path + " has no extension of a format that is known here");
}

void check_file(const Scene& scene, const std::string& path) {
  const Encoding* wanted = encoding_of_extension(path);
  if (!wanted || scene.image.format == wanted->format) return;
  throw CommandError(exit_refused, "the scene asks for " +
                                       std::string(encoding(scene.image.format).name) + ", " +
                                       path + " for " + std::string(wanted->name));
}

Scene scene_for_file(const nlohmann::json& document, const std::string& path) {
  Scene scene = read_scene(document_for_file(document, path));
  check_file(scene, path);
  return scene;
}

}  // namespace cyanometer
