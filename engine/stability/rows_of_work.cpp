// Rows about how work is done rather than what is computed.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;

StabilityRow long_dispatches() {
  StabilityRow row{.number = 23,
                   .name = "Long dispatches",
                   .trigger = "longest dispatch allowed, ms",
                   .quantity = "relative difference of values whose work was cut to 50 ms",
                   .bound = 1e-6,
                   .sweep = {2, 10},
                   .hardest = 2};
  row.scene = [](double) { return changed(plain_scene(), {{"sun", {{"elevation_deg", 8}}}}); };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan(spaced(1, 89, 20), spaced(0, 180, 20));
    Radiances usual = trial.look(scene(x), rays);
    EngineOptions options;
    options.device = trial.engine().device().name;
    options.longest_dispatch_ms = x;
    Engine hurried(options);
    Radiances cut = Trial(hurried, trial.method(), {}, trial.most_work(), trial.watch())
                        .look(scene(x), rays, usual.plan);
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return apart(usual.radiance[i][c], cut.radiance[i][c], 0);
    })};
  };
  return row;
}

}  // namespace

std::vector<StabilityRow> rows_of_work() { return {long_dispatches()}; }

}  // namespace cyanometer
