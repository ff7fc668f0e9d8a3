// cyanometer composite: the scene's air over a picture with distances, without a server.
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/commands/image_file.h"
#include "server/routes/composite_scene.h"

namespace cyanometer {
namespace {

struct CompositeArguments {
  std::string picture, scene, output, device;
  double scale = 1;
};

void composite(const CompositeArguments& arguments) {
  const std::string bytes = read_file(arguments.picture);
  Scene scene;
  Picture picture;
  try {
    scene = scene_for_file(sized_as(read_document(arguments.scene), bytes), arguments.output);
    check_composite(scene);
    picture = read_picture(bytes, scene, arguments.scale);
  } catch (const ImageError& error) {
    throw CommandError(exit_refused, arguments.picture + ": " + error.what());
  }
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const Frame frame = engine.composite(scene, picture, watch);
  end_progress();
  write_file(arguments.output, encode(frame, scene));
}

}  // namespace

void add_composite(CLI::App& app) {
  auto* command =
      app.add_subcommand("composite", "Lay the scene's air over a picture with distances");
  const auto arguments = std::make_shared<CompositeArguments>();
  command
      ->add_option("picture", arguments->picture,
                   "EXR of R, G, B, and Z, the distance along each ray in km")
      ->required();
  command
      ->add_option("scene", arguments->scene,
                   "Scene document; - is standard input; its frame is as large as the picture")
      ->required();
  command->add_option("-o,--output", arguments->output, "Image file; - is standard output")
      ->required();
  command
      ->add_option("--scale", arguments->scale,
                   "What 1.0 in the picture is worth in the unit of this program's own files: "
                   "1.0 of those is 1000 cd/m^2, or the picture's whiteLuminance; with colour "
                   "channels, the scene's unit of spectral radiance")
      ->check(CLI::Range(least_scale, most_scale));
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Example: cyanometer composite landscape.exr scene.json --scale 30 -o landscape.png");
  command->callback([arguments] { composite(*arguments); });
}

}  // namespace cyanometer
