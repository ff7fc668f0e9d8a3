// cyanometer explain: what each ingredient of a scene is worth.
#include "engine/accuracy/ingredients.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/routes/answers.h"

namespace cyanometer {
namespace {

struct ExplainArguments {
  std::string scene, device;
  bool json = false;
};

std::string row(const Worth& worth) {
  char text[128];
  const std::string difference =
      worth.ciede2000 ? nlohmann::json(std::round(*worth.ciede2000 * 100) / 100).dump() : "-";
  std::snprintf(text, sizeof text, "%-32s %9.3g %% %10s %10.4g\n", worth.name.c_str(),
                100 * worth.error, difference.c_str(), worth.ms_saved);
  return text;
}

/// Largest error first.
std::string table(std::vector<Worth> ingredients) {
  std::ranges::stable_sort(ingredients, std::ranges::greater(), &Worth::error);
  char head[128];
  std::snprintf(head, sizeof head, "%-32s %11s %10s %10s\n", "left out", "error", "CIEDE2000",
                "ms saved");
  std::string out = head;
  for (const Worth& worth : ingredients) out += row(worth);
  return out;
}

void explain_scene(const ExplainArguments& arguments) {
  const Scene scene = read_scene(read_document(arguments.scene));
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const std::vector<Worth> ingredients = explain(engine, scene, watch);
  end_progress();
  write_file("-", arguments.json ? explanation_document(ingredients).dump(2) + "\n"
                                 : table(ingredients));
}

}  // namespace

void add_explain(CLI::App& app) {
  auto* command =
      app.add_subcommand("explain", "What each ingredient of a scene is worth, as a table");
  const auto arguments = std::make_shared<ExplainArguments>();
  command->add_option("scene", arguments->scene, "Scene document; - is standard input")
      ->required();
  command->add_flag("--json", arguments->json, "The document of POST /v1/explain instead");
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer("Example: echo '{\"preset\":\"earth_twilight\"}' | cyanometer explain -");
  command->callback([arguments] { explain_scene(*arguments); });
}

}  // namespace cyanometer
