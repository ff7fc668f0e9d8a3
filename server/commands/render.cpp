// cyanometer render: a scene to a file, without a server.
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/commands/image_file.h"

namespace cyanometer {
namespace {

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
