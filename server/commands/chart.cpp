// cyanometer chart: speed against accuracy of every method, as a picture and as tables.
#include "engine/accuracy/chart.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <span>

#include "engine/accuracy/chart_svg.h"
#include "engine/scene/document.h"
#include "server/commands/chart_options.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Ground, air, limb and disc; noon, low sun, twilight and haze; other planets.
constexpr const char* usual_presets[] = {"earth_noon", "earth_low_sun", "earth_twilight",
                                         "earth_hazy", "earth_10km",    "earth_limb",
                                         "earth_disc", "mars",          "titan"};

struct ChartArguments {
  std::vector<std::string> files, presets;
  std::string folder, device;
  ChartSettings settings;
};

std::vector<ChartScene> scenes_of(const ChartArguments& arguments) {
  std::vector<ChartScene> scenes;
  auto add = [&](const std::string& name, const json& document) {
    Scene scene = charted(read_scene(document), arguments.settings.pixels);
    scenes.push_back({name, canonical(scene), 0, 0, {}});
  };
  for (const std::string& file : arguments.files) {
    add(file == "-" ? "scene" : std::filesystem::path(file).stem().string(),
        read_document(file));
  }
  for (const std::string& preset : arguments.presets) add(preset, {{"preset", preset}});
  if (scenes.empty()) {
    for (const char* preset : usual_presets) add(preset, {{"preset", preset}});
  }
  return scenes;
}

void resume(const std::filesystem::path& file, Chart& chart) {
  if (!std::filesystem::exists(file)) return;
  try {
    take_over(chart_from(read_document(file.string())), chart);
  } catch (const std::exception& error) {
    throw CommandError(exit_failed, file.string() + " is no chart: " + error.what());
  }
}

void write(const std::filesystem::path& folder, const Chart& chart) {
  write_file((folder / "chart.json").string(), chart_document(chart).dump(1) + "\n");
  write_file((folder / "chart.csv").string(), chart_csv(chart));
  write_file((folder / "chart.svg").string(), chart_svg(chart));
}

void chart(const ChartArguments& arguments) {
  const Watch watch = command_watch();
  const std::filesystem::path folder = arguments.folder;
  std::filesystem::create_directories(folder);
  Engine engine = command_engine(arguments.device);
  Chart chart{engine.device().name, version(), scenes_of(arguments)};
  const std::size_t asked = chart.scenes.size();
  resume(folder / "chart.json", chart);
  for (ChartScene& scene : std::span(chart.scenes).last(asked)) {
    measure_points(
        engine, arguments.settings, watch,
        [&](const ChartPoint& point) {
          end_progress();
          std::fprintf(stderr, "%s, %s: ", scene.name.c_str(), point.method.c_str());
          if (point.failure.empty()) {
            std::fprintf(stderr, "error %.2g %%, %.3g ms a frame, %.3g ms of tables\n",
                         100 * point.error.measure.error, point.frame_ms, point.tables_ms);
          } else {
            std::fprintf(stderr, "%s\n", point.failure.c_str());
          }
          write(folder, chart);
        },
        scene);
  }
  end_progress();
  write(folder, chart);
}

}  // namespace

void add_chart(CLI::App& app) {
  auto* command = app.add_subcommand(
      "chart",
      "Speed against accuracy of every method, as chart.svg, chart.csv and chart.json");
  const auto arguments = std::make_shared<ChartArguments>();
  ChartSettings& settings = arguments->settings;
  command->add_option(
      "scene", arguments->files,
      "Scene documents, - is standard input; without any, presets that span what there is");
  command->add_option("--preset", arguments->presets, "Presets; may be repeated")
      ->check(CLI::IsMember(preset_names()));
  command->add_option("-o,--output", arguments->folder, "Folder; what is there goes on")
      ->required();
  add_chart_options(*command, settings);
  command
      ->add_option("--longest-ms", settings.longest_ms,
                   "Costlier settings than one whose frame takes longer are left out")
      ->check(CLI::Range(1.0, 1e7))
      ->capture_default_str();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Errors are in the README's measure against path; where a scene leaves its "
      "wavelengths\n"
      "open, three are charted. Times are of the device. A run that was stopped goes on, and "
      "other\nscenes that are in the folder stay in the chart.\n"
      "Example: cyanometer chart my_sky.json -o my_chart");
  command->callback([arguments] { chart(*arguments); });
}

}  // namespace cyanometer
