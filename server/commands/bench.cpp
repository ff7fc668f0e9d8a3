// cyanometer bench: what each method costs and how wrong it is, preset by preset.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;

struct Arguments {
  std::string device, json_output;
  std::vector<std::string> presets, methods;
  int rays = 256, samples = 4096, width = 320, height = 180;
};

/// One method on one scene.
struct Row {
  std::string preset, method;
  ErrorMeasure error;
  double noise = 0;  ///< of the reference, in the same measure
  double device_ms = 0, tables_ms = 0, tables_mib = 0;
  std::string failure;  ///< why there are no figures
};

/// The preset at three wavelengths, so that methods are compared and not their colours.
json scene_document(const std::string& preset, const std::string& method, const json& options) {
  json document{{"preset", preset}, {"method", {{"name", method}}}};
  document["method"].update(options);
  if (read_scene({{"preset", preset}}).spectrum.wavelengths_nm.empty()) {
    document["spectrum"]["wavelengths_nm"] = {680, 550, 440};
  }
  return document;
}

/// Two independent halves of the converged solution.
struct Reference {
  std::vector<Direction> directions;
  Samples mean;
  double noise = 0;

  Reference(Engine& engine, const std::string& preset, const Arguments& arguments,
            const Watch& watch) {
    std::vector<Samples> halves;
    for (int seed : {1, 2}) {
      Scene scene = read_scene(scene_document(
          preset, "path", {{"samples_per_pixel", arguments.samples}, {"seed", seed}}));
      directions = sample_directions(scene, arguments.rays);
      halves.push_back(engine.radiance(scene, directions, false, watch).radiance);
    }
    mean = halves[0];
    for (std::size_t i = 0; i < mean.size(); ++i) {
      for (std::size_t w = 0; w < mean[i].size(); ++w) {
        mean[i][w] = 0.5 * (mean[i][w] + halves[1][i][w]);
      }
    }
    // The mean's error is half of the halves' difference.
    noise = measure_error(halves[0], halves[1]).error / 2;
  }
};

/// A frame of a method whose tables are not there yet, then the same again: the time of the
/// tables and that of the frame.
void measure_time(const Scene& scene, const Arguments& arguments, const Watch& watch,
                  Row& row) {
  Engine fresh({.device = arguments.device});
  fresh.warm();
  std::vector<double> times;
  TableUse before = fresh.tables();
  for (int i = 0; i < 4; ++i) times.push_back(fresh.render(scene, watch).render_ms);
  TableUse after = fresh.tables();
  row.tables_ms = after.making_ms - before.making_ms;
  row.tables_mib = static_cast<double>(after.bytes) / (1 << 20);
  std::sort(times.begin() + 1, times.end());
  row.device_ms = times[2];
}

Row measure(Engine& engine, const std::string& preset, const std::string& method,
            const Reference& reference, const Arguments& arguments, const Watch& watch) {
  Row row{preset, method, {}, reference.noise, 0, 0, 0, ""};
  try {
    json document = scene_document(preset, method, json::object());
    Scene scene = read_scene(document);
    row.error = measure_error(
        engine.radiance(scene, reference.directions, false, watch).radiance, reference.mean);
    if (scene.camera.projection == Projection::perspective) {
      document["image"] = {{"width", arguments.width}, {"height", arguments.height}};
    }
    measure_time(read_scene(document), arguments, watch, row);
  } catch (const OverLimit& limit) {
    row.failure = limit.what();
  }
  return row;
}

std::string share(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * value);
  return text;
}

void print_heading() {
  std::cout
      << "| preset | method | error | bias | 99 % | noise | device ms | tables ms | MiB |\n"
         "|---|---|---|---|---|---|---|---|---|\n";
}

void print(const Row& row) {
  if (!row.failure.empty()) {
    std::cout << "| " << row.preset << " | " << row.method << " | " << row.failure
              << " | | | | | | |\n";
    return;
  }
  char times[96];
  std::snprintf(times, sizeof times, "%.1f | %.1f | %.1f", row.device_ms, row.tables_ms,
                row.tables_mib);
  std::cout << "| " << row.preset << " | " << row.method << " | " << share(row.error.error)
            << " | " << share(row.error.bias) << " | " << share(row.error.p99) << " | "
            << share(row.noise) << " | " << times << " |\n";
  std::cout.flush();
}

json as_json(const Row& row) {
  return {{"preset", row.preset},        {"method", row.method},
          {"failure", row.failure},      {"error", row.error.error},
          {"bias", row.error.bias},      {"p99", row.error.p99},
          {"max", row.error.max},        {"reference_noise", row.noise},
          {"device_ms", row.device_ms},  {"tables_ms", row.tables_ms},
          {"tables_mib", row.tables_mib}};
}

void bench(const Arguments& arguments) {
  Watch watch = command_watch();
  Engine engine({.device = arguments.device});
  auto wanted = [](const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::ranges::find(names, name) != names.end();
  };
  json rows = json::array();
  print_heading();
  for (const Preset& preset : presets()) {
    if (!wanted(arguments.presets, preset.name)) continue;
    Reference reference(engine, preset.name, arguments, watch);
    for (const MethodDescription& method : methods()) {
      if (!wanted(arguments.methods, method.name) || method.random) continue;
      Row row = measure(engine, preset.name, method.name, reference, arguments, watch);
      end_progress();
      print(row);
      rows.push_back(as_json(row));
    }
  }
  if (!arguments.json_output.empty()) write_file(arguments.json_output, rows.dump(1) + "\n");
}

}  // namespace

void add_bench(CLI::App& app) {
  auto* command = app.add_subcommand(
      "bench", "What each method costs and how wrong it is, preset by preset, as a table");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--preset", arguments->presets, "Only these; may be repeated");
  command->add_option("--method", arguments->methods, "Only these; may be repeated");
  command->add_option("--rays", arguments->rays, "Rays on which errors are measured")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command
      ->add_option("--samples", arguments->samples, "Paths a ray of each half of the reference")
      ->check(CLI::Range(16, 1 << 20))
      ->capture_default_str();
  command->add_option("--json", arguments->json_output, "Also as JSON in this file");
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Errors are in the contract's measure against path, at three wavelengths; times are "
      "medians\n"
      "of frames of 320 x 180 with tables made, and of the tables.\n"
      "Example: cyanometer bench --preset earth --preset mars_sunset");
  command->callback([arguments] { bench(*arguments); });
}

}  // namespace cyanometer
