// cyanometer tables: the tables of the method `bruneton` for a scene, as pictures.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/image/panels.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

struct TablesArguments {
  std::string scene, preset, folder, device;
};

/// The scene with this method, as the scene tells it if it names it, and with three wavelengths
/// where it leaves them open.
Scene with_tables(Scene scene) {
  if (scene.method.name != "bruneton") {
    const auto orders = scene.method.scattering_orders;
    scene.method = read_scene({{"method", {{"name", "bruneton"}}}}).method;
    scene.method.scattering_orders = orders;
  }
  if (scene.spectrum.wavelengths_nm.empty()) {
    scene.spectrum = {{680, 550, 440}, Colour::channels};
  }
  return scene;
}

nlohmann::json document(const TablesArguments& arguments) {
  if (arguments.scene.empty() == arguments.preset.empty()) {
    throw CommandError(exit_refused, "either a scene or a preset is needed");
  }
  return arguments.scene.empty() ? nlohmann::json{{"preset", arguments.preset}}
                                 : read_document(arguments.scene);
}

std::string png(const Panels& panels) {
  Frame frame = picture_of(panels);
  frame.description = nlohmann::json{{"version", version()}}.dump();
  Scene as_png;
  as_png.image.width = frame.width;
  as_png.image.height = frame.height;
  return encode(frame, as_png);
}

void tables(const TablesArguments& arguments) {
  const Scene scene = with_tables(read_scene(document(arguments)));
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const std::vector<Panels> all = engine.table_panels(scene, watch);
  end_progress();
  if (all.empty()) {
    throw CommandError(exit_refused,
                       "one order of scattering has no tables, unless "
                       "/method/first_order is 1");
  }
  const std::filesystem::path folder = arguments.folder;
  std::filesystem::create_directories(folder);
  std::string lines;
  for (const Panels& panels : all) {
    const std::string file = (folder / (panels.name + ".png")).string();
    write_file(file, png(panels));
    lines += file + ": " + panels.title + "\n";
  }
  write_file("-", lines);
}

}  // namespace

void add_tables(CLI::App& app) {
  auto* command =
      app.add_subcommand("tables", "The tables of the method bruneton for a scene, as PNGs");
  const auto arguments = std::make_shared<TablesArguments>();
  command->add_option("scene", arguments->scene, "Scene document; - is standard input");
  command->add_option("--preset", arguments->preset, "Instead: a preset")
      ->check(CLI::IsMember(preset_names()));
  command->add_option("-o,--output", arguments->folder, "Folder")->required();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "The options are the scene's where it names this method, else the defaults; gather 0\n"
      "shows the four-dimensional table of the view, first_order 1 those of the first order.\n"
      "Example: cyanometer tables --preset earth_low_sun -o my_tables");
  command->callback([arguments] { tables(*arguments); });
}

}  // namespace cyanometer
