// cyanometer bench: what each method costs and how wrong it is, preset by preset.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "engine/accuracy/chart.h"
#include "engine/scene/document.h"
#include "server/commands/chart_options.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

struct BenchArguments {
  std::string device, json_output;
  std::vector<std::string> presets;
  ChartSettings settings;
};

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

void print(const ChartScene& scene, const ChartPoint& point) {
  std::cout << "| " << scene.name << " | " << point.method << " | ";
  if (!point.failure.empty()) {
    std::cout << point.failure << " | | | | | | |\n";
    return;
  }
  char times[96];
  std::snprintf(times, sizeof times, "%.1f | %.1f | %.1f", point.frame_ms, point.tables_ms,
                point.tables_mib);
  const ErrorMeasure& measure = point.error.measure;
  std::cout << percent(measure.error) << " | " << percent(measure.bias) << " | "
            << percent(measure.p99) << " | " << percent(scene.noise) << " | " << times << " |"
            << std::endl;
}

void bench(const BenchArguments& arguments) {
  Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  Chart chart{engine.device().name, version(), {}};
  std::cout
      << "| preset | method | error | bias | 99 % | noise | device ms | tables ms | MiB |\n"
         "|---|---|---|---|---|---|---|---|---|\n";
  for (const Preset& preset : presets()) {
    const std::vector<std::string>& wanted = arguments.presets;
    if (!wanted.empty() && std::ranges::find(wanted, preset.name) == wanted.end()) continue;
    Scene scene = charted(read_scene({{"preset", preset.name}}), arguments.settings.pixels);
    ChartScene row{preset.name, canonical(scene), 0, 0, {}};
    measure_points(
        engine, arguments.settings, watch,
        [&](const ChartPoint& point) {
          end_progress();
          print(row, point);
        },
        row);
    chart.scenes.push_back(std::move(row));
  }
  if (!arguments.json_output.empty()) {
    write_file(arguments.json_output, chart_document(chart).dump(1) + "\n");
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  auto* command = app.add_subcommand(
      "bench", "What each method costs and how wrong it is, preset by preset, as a table");
  const auto arguments = std::make_shared<BenchArguments>();
  ChartSettings& settings = arguments->settings;
  settings.defaults_only = true;
  settings.reference = {256, 0.003, 4096};
  command->add_option("--preset", arguments->presets, "Only these; may be repeated")
      ->check(CLI::IsMember(preset_names()));
  add_chart_options(*command, settings);
  command->add_option("--json", arguments->json_output, "Also as JSON in this file");
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Methods at their defaults; `chart` varies them. Errors are in the README's measure\n"
      "against path, at three wavelengths; times are of frames with tables made, and of the "
      "tables.\n"
      "Example: cyanometer bench --preset earth --preset mars_sunset");
  command->callback([arguments] { bench(*arguments); });
}

}  // namespace cyanometer
