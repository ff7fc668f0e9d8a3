// Options of methods where they are smallest.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "engine/stability/row.h"
#include "engine/stability/trial.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

/// The least that an option may be, and what follows: where 0 stands for what suits the scene,
/// that is the least that is taken at its word.
std::vector<double> smallest_values(const MethodOption& option) {
  const double next = option.minimum + (option.integer ? 1 : 1e-6);
  return {option.minimum, std::min(next, option.maximum)};
}

/// Radiances that are not finite, or negative, throw; a division by 0 ends the process.
TEST(Options, OfAllMethodsMayBeAsSmallAsTheySay) {
  const nlohmann::json scene = plain_scene();
  const auto directions = fan({60, 2, -2}, {0, 100});
  const Watch watch;
  for (const MethodDescription& method : methods()) {
    Trial trial(device(), method.name, {}, 1, watch);
    for (const MethodOption& option : method.options) {
      for (const double value : smallest_values(option)) {
        nlohmann::json asked = scene;
        asked["method"] = {{"name", method.name}, {option.name, value}};
        const Scene read = read_scene(asked);
        Plan plan;
        plan.method = method.name;
        plan.options = read.method.options;
        plan.wavelengths_nm = wavelengths_of(read);
        EXPECT_NO_THROW(trial.look(asked, directions, plan))
            << method.name << " " << option.name << " " << value;
      }
    }
  }
}

}  // namespace
}  // namespace cyanometer
