// The questions that this program grew out of, asked again with an error beside each answer: a
// thesis on the nested march, a dissection of precomputed scattering, and a planet renderer.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

/// Smaller for tests.
struct ExperimentSettings {
  int rays = 256;      ///< on which errors are measured
  int pixels = 57600;  ///< of frames that are timed
  int most_samples = 256;
};

struct Finding {
  std::string markdown;                      ///< a section without its head
  std::map<std::string, std::string> files;  ///< pictures that it shows, by name
};

struct Experiment {
  std::string name, title, about;
  /// @throws OverLimit, Cancelled, DeviceLost
  std::function<Finding(Engine& engine, const ExperimentSettings& settings, const Watch& watch)>
      run;
};

const std::vector<Experiment>& experiments();

/// Ten settings of the nested march: frames a second, and how wrong they are.
Finding sample_pairs(Engine& engine, const ExperimentSettings& settings, const Watch& watch);
/// Error over view by light samples, and the best split of each cost.
Finding sample_map(Engine& engine, const ExperimentSettings& settings, const Watch& watch);
/// Error of the first orders of scattering against all.
Finding orders_kept(Engine& engine, const ExperimentSettings& settings, const Watch& watch);
/// The sky under tops of the air from low to high.
Finding heights_of_the_top(Engine& engine, const ExperimentSettings& settings,
                           const Watch& watch);
/// Precomputed tables by linear and other mappings.
Finding table_mappings(Engine& engine, const ExperimentSettings& settings, const Watch& watch);
/// Air that thins out as a square against exponential air of the same column.
Finding quadratic_air(Engine& engine, const ExperimentSettings& settings, const Watch& watch);
/// Two settings of the nested march with and without a tone map.
Finding with_and_without_hdr(Engine& engine, const ExperimentSettings& settings,
                             const Watch& watch);

}  // namespace cyanometer
