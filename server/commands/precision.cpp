// cyanometer precision: what the precision of the device's numbers alone is worth.
#include <algorithm>
#include <iostream>
#include <memory>

#include "engine/accuracy/chart.h"
#include "engine/accuracy/precision.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

struct PrecisionArguments {
  std::string device;
  std::vector<std::string> presets;
};

constexpr int pixels = 57600;  // as `bench` draws

void precision(const PrecisionArguments& arguments) {
  const Watch watch = command_watch();
  PrecisionTrial trial(arguments.device);
  std::cout << precision_table_head() << std::flush;
  std::size_t done = 0;
  for (const Preset& preset : presets()) {
    show_progress(static_cast<double>(done++) / static_cast<double>(presets().size()),
                  preset.name);
    const std::vector<std::string>& wanted = arguments.presets;
    if (!wanted.empty() && std::ranges::find(wanted, preset.name) == wanted.end()) continue;
    const Scene scene = charted(read_scene({{"preset", preset.name}}), pixels);
    std::vector<PrecisionPoint> by_method;
    for (const MethodDescription& method : methods())
      by_method.push_back(trial.measure(scene, method.name, watch));
    end_progress();
    std::cout << precision_table_line(preset.name, by_method) << std::flush;
  }
  end_progress();
}

}  // namespace

void add_precision(CLI::App& app) {
  auto* command = app.add_subcommand(
      "precision", "What the precision of the device's numbers alone is worth, as a table");
  const auto arguments = std::make_shared<PrecisionArguments>();
  command->add_option("--preset", arguments->presets, "Only these; may be repeated")
      ->check(CLI::IsMember(preset_names()));
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Methods at their defaults, at three wavelengths, with every operation rounded up, down\n"
      "and towards zero against all rounded to nearest: the largest error of the three in the\n"
      "README's measure, of random walks their mean difference and its standard error.\n"
      "Software devices only: their rounding can be turned.\n"
      "Example: cyanometer precision --preset earth --preset titan");
  command->callback([arguments] { precision(*arguments); });
}

}  // namespace cyanometer
