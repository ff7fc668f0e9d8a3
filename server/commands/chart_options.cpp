#include "server/commands/chart_options.h"

#include "engine/cache_folder.h"
#include "server/commands/command.h"

namespace cyanometer {

void add_reference_options(CLI::App& command, ReferenceGoal& goal,
                           std::filesystem::path& folder) {
  folder = cache_folder("references");
  command.add_option("--rays", goal.rays, "Rays on which errors are measured")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command.add_option("--noise", goal.noise, "Of the reference, at most")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  command
      .add_option("--most-walks", goal.most_walks,
                  "A ray in each half of the reference, however noisy that leaves it")
      ->check(CLI::Range(256, 1 << 20))
      ->capture_default_str();
  command.add_option("--references", folder, "Folder of references")->capture_default_str();
}

void add_chart_options(CLI::App& command, ChartSettings& settings) {
  command.add_option("--method", settings.methods, "Only these; may be repeated")
      ->check(CLI::IsMember(method_names()));
  add_reference_options(command, settings.reference, settings.references);
  command.add_option("--pixels", settings.pixels, "Of the frames that are timed")
      ->check(CLI::Range(64, 1 << 24))
      ->capture_default_str();
}

}  // namespace cyanometer
