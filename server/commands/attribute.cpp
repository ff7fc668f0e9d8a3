// cyanometer attribute: where the error of a method comes from.
#include "engine/accuracy/attribution.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/accuracy/precision.h"
#include "engine/scene/document.h"
#include "server/commands/chart_options.h"
#include "server/commands/command.h"
#include "server/routes/answers.h"

namespace cyanometer {
namespace {

struct AttributeArguments {
  std::string scene, device;
  ReferenceGoal goal;
  std::filesystem::path references;
  bool json = false;
};

/// Only software devices can tell; of others there is nothing to say.
void add_float(const std::string& device, const Scene& scene, const Watch& watch,
               Attribution& attribution) {
  std::optional<PrecisionTrial> trial;
  try {
    trial.emplace(device);
  } catch (const std::runtime_error&) {
    return;
  }
  const PrecisionPoint point = trial->measure(scene, attribution.plan, watch);
  attribution.shares.push_back(
      {"float", std::abs(point.error), "operations rounded otherwise"});
}

std::string table(const Attribution& attribution) {
  char text[160];
  std::string out = attribution.plan.method;
  for (const auto& [name, value] : attribution.plan.options) {
    std::snprintf(text, sizeof text, " %s=%g", name.c_str(), value);
    out += text;
  }
  const EstimatedError& error = attribution.error;
  std::snprintf(text, sizeof text,
                "\nerror %.3g %% (95 %%: %.3g to %.3g), the reference's noise %.2g %%\n\n",
                100 * error.measure.error, 100 * error.low, 100 * error.high,
                100 * attribution.reference_noise);
  out += text;
  for (const ErrorShare& share : attribution.shares) {
    std::snprintf(text, sizeof text, "%-12s %9.3g %%  ", share.cause.c_str(),
                  100 * share.error);
    out += text + share.how + "\n";
  }
  return out;
}

void attribute_scene(const AttributeArguments& arguments) {
  const Scene scene = read_scene(read_document(arguments.scene));
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  Attribution attribution =
      attribute(engine, scene, arguments.goal, arguments.references, watch);
  add_float(arguments.device, scene, watch, attribution);
  end_progress();
  write_file("-", arguments.json ? attribution_document(attribution).dump(2) + "\n"
                                 : table(attribution));
}

}  // namespace

void add_attribute(CLI::App& app) {
  auto* command = app.add_subcommand(
      "attribute", "Where the error of a scene's method comes from, as a table");
  const auto arguments = std::make_shared<AttributeArguments>();
  command->add_option("scene", arguments->scene, "Scene document; - is standard input")
      ->required();
  add_reference_options(*command, arguments->goal, arguments->references);
  command->add_flag("--json", arguments->json, "A document instead");
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Of the setting that the scene's method asks for, or that auto chooses: its error "
      "against\n"
      "path in the README's measure, and what each cause alone is worth. Quadrature is what\n"
      "four times as many nodes change, tables what twice as large ones do, float what "
      "another\n"
      "rounding of every operation does (on software devices). Shares need not add up.\n"
      "Example: echo '{\"preset\":\"earth_low_sun\",\"method\":{\"name\":\"hillaire\"}}' | "
      "cyanometer attribute -");
  command->callback([arguments] { attribute_scene(*arguments); });
}

}  // namespace cyanometer
