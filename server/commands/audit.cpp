// cyanometer audit: whether plans keep their word, on random scenes.
#include "engine/accuracy/audit.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/cache_folder.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct AuditArguments {
  std::string file, device;
  std::uint64_t first = 0;
  int scenes = 200;
  ReferenceGoal goal{256, 0.001, 4096};
  std::filesystem::path references = cache_folder("references");
};

/// What an earlier run of this version on this device left that was measured as this one
/// measures, one scene a line.
std::vector<json> read_lines(const std::string& path, const json& by) {
  std::vector<json> scenes;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    json scene = json::parse(line, nullptr, false);
    if (scene.is_object() && scene.value("by", json()) == by)
      scenes.push_back(std::move(scene));
  }
  return scenes;
}

void audit(const AuditArguments& arguments) {
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const json by{{"version", version()},
                {"device", engine.device().name},
                {"goal", goal_document(arguments.goal)}};
  std::vector<json> scenes = read_lines(arguments.file, by);
  std::ofstream out(arguments.file, std::ios::app);
  if (!out) throw CommandError(exit_failed, "cannot write " + arguments.file);
  for (std::uint64_t seed = arguments.first; seed < arguments.first + arguments.scenes;
       ++seed) {
    auto known = [&](const json& scene) { return scene.at("seed") == seed; };
    if (std::ranges::any_of(scenes, known)) continue;
    scenes.push_back(audit_scene(engine, seed, arguments.goal, arguments.references, watch));
    scenes.back()["by"] = by;
    out << scenes.back() << std::endl;
    end_progress();
    std::fprintf(stderr, "%zu scenes\r", scenes.size());
  }
  end_progress();
  std::cout << audit_report(scenes);
}

}  // namespace

void add_audit(CLI::App& app) {
  auto* command =
      app.add_subcommand("audit", "Whether plans keep their word, on random scenes");
  const auto arguments = std::make_shared<AuditArguments>();
  command
      ->add_option("-o,--output", arguments->file,
                   "File of one scene's figures a line; what is there goes on")
      ->required();
  command->add_option("--scenes", arguments->scenes, "How many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--first", arguments->first, "The first seed")->capture_default_str();
  command->add_option("--rays", arguments->goal.rays, "Rays on which errors are measured")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command->add_option("--noise", arguments->goal.noise, "Of the reference, at most")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  command
      ->add_option("--most-walks", arguments->goal.most_walks,
                   "A ray in each half of the reference, however noisy that leaves it")
      ->check(CLI::Range(256, 1 << 20))
      ->capture_default_str();
  command->add_option("--references", arguments->references, "Folder of references")
      ->capture_default_str();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Long; a run that was stopped goes on.\n"
      "Example: cyanometer audit --scenes 200 -o audit.jsonl");
  command->callback([arguments] { audit(*arguments); });
}

}  // namespace cyanometer
