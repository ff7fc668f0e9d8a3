// cyanometer render: a scene to a file, without a server.
#include <algorithm>
#include <filesystem>
#include <memory>
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

/// The scene with the file's format, where it names none itself.
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

struct Arguments {
  std::string scene, output, device;
};

void render(const Arguments& arguments) {
  const Scene scene = scene_for_file(read_document(arguments.scene), arguments.output);
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const Frame frame = engine.render(scene, watch);
  end_progress();
  write_file(arguments.output, encode(frame, scene));
}

}  // namespace

void add_render(CLI::App& app) {
  auto* command = app.add_subcommand("render", "Render a scene to a file");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("scene", arguments->scene, "Scene document; - is standard input")
      ->required();
  command->add_option("-o,--output", arguments->output, "Image file; - is standard output")
      ->required();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer("Example: echo '{\"preset\":\"mars\"}' | cyanometer render - -o mars.exr");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace cyanometer
