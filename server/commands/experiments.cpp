// cyanometer experiments: the questions that the program grew out of, with their answers.
#include "engine/experiments/experiments.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "server/commands/command.h"

namespace cyanometer {
namespace {

struct ExperimentArguments {
  std::string folder, device;
  std::vector<std::string> only;
  ExperimentSettings settings;
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Experiment& experiment : experiments()) all.push_back(experiment.name);
  return all;
}

void run_experiments(const ExperimentArguments& arguments) {
  const Watch watch = command_watch();
  const std::filesystem::path folder = arguments.folder;
  std::filesystem::create_directories(folder);
  Engine engine = command_engine(arguments.device);
  std::string report =
      "# The questions that this program grew out of\n\n(`cyanometer experiments -o folder`, "
      "on " +
      engine.device().name +
      ".) Errors are in the README's measure, of order one against the finest quadrature, of "
      "more against the finest moment tables.\n";
  double done = 0;
  for (const Experiment& experiment : experiments()) {
    const auto& only = arguments.only;
    show_progress(done++ / static_cast<double>(experiments().size()), experiment.name);
    if (!only.empty() && std::ranges::find(only, experiment.name) == only.end()) continue;
    Finding finding = experiment.run(engine, arguments.settings, watch);
    report +=
        "\n## " + experiment.title + "\n\n" + experiment.about + "\n\n" + finding.markdown;
    for (const auto& [name, content] : finding.files)
      write_file((folder / name).string(), content);
    write_file((folder / "experiments.md").string(), report);
  }
  end_progress();
}

}  // namespace

void add_experiments(CLI::App& app) {
  auto* command = app.add_subcommand(
      "experiments",
      "The questions that the program grew out of, as experiments.md and pictures");
  const auto arguments = std::make_shared<ExperimentArguments>();
  command->add_option("-o,--output", arguments->folder, "Folder")->required();
  command->add_option("--only", arguments->only, "Only these; may be repeated")
      ->check(CLI::IsMember(names()));
  command->add_option("--rays", arguments->settings.rays, "Rays on which errors are measured")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer("Example: cyanometer experiments --only map -o experiments");
  command->callback([arguments] { run_experiments(*arguments); });
}

}  // namespace cyanometer
