#include "server/commands/chart_options.h"

#include "engine/cache_folder.h"

namespace cyanometer {

void add_chart_options(CLI::App& command, ChartSettings& settings) {
  settings.references = cache_folder("references");
  command.add_option("--method", settings.methods, "Only these; may be repeated");
  command.add_option("--rays", settings.reference.rays, "Rays on which errors are measured")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command.add_option("--noise", settings.reference.noise, "Of the reference, at most")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  command
      .add_option("--most-walks", settings.reference.most_walks,
                  "A ray in each half of the reference, however noisy that leaves it")
      ->check(CLI::Range(256, 1 << 20))
      ->capture_default_str();
  command.add_option("--pixels", settings.pixels, "Of the frames that are timed")
      ->check(CLI::Range(64, 1 << 24))
      ->capture_default_str();
  command.add_option("--references", settings.references, "Folder of references")
      ->capture_default_str();
}

}  // namespace cyanometer
