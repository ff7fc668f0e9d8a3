// The bound on radiance that random scenes are held against: reached where it can be, and
// passed by none.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/document.h"
#include "engine/stability/brightest.h"
#include "engine/stability/row.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

double bound(const json& document) {
  Scene scene = read_scene(document);
  return brightest_possible(scene, wavelengths_of(scene)).front();
}

/// Particles alone, so many that no light comes through, seen from above.
json fog(const json& phase) {
  return changed(empty_scene(), {{"method", {{"scattering_orders", 1}}},
                                 {"camera", {{"altitude_km", 200}}},
                                 {"atmosphere",
                                  {{"constituents",
                                    {{"fog",
                                      {{"type", "particles"},
                                       {"optical_depth", 1e4},
                                       {"single_scattering_albedo", 1},
                                       {"phase", phase},
                                       {"profile", {{"type", "uniform"}}}}}}}}}});
}

TEST(Brightest, OfOneOrderIsThePeakOfThePhaseFunctionInTheUnitOfTheSun) {
  double g = 0.6, peak = (1 - g * g) / (4 * std::numbers::pi * std::pow(1 - g, 3));
  json scene = fog({{"type", "henyey_greenstein"}, {"g", g}});
  EXPECT_NEAR(bound(scene) / peak, 1, 1e-9);
  scene["sun"]["irradiance"] = 7;
  EXPECT_NEAR(bound(scene) / (7 * peak), 1, 1e-9);
  scene["method"]["scattering_orders"] = 3;
  EXPECT_NEAR(bound(scene) / (21 * peak), 1, 1e-9);
}

TEST(Brightest, IsNearlyReachedByABeamThatComesStraightBack) {
  // A backward peak, the sun behind the camera: light that is scattered at a depth is dimmed as
  // much on its way in as on its way out, and half of it is seen.
  static const Watch watch;
  json scene = fog({{"type", "henyey_greenstein"}, {"g", -0.6}});
  scene["sun"]["elevation_deg"] = 90;
  Trial asked(device(), "raymarch", {}, 1, watch);
  double seen = asked.look(scene, {{-90, 0}}).radiance[0][0];
  double most = bound(scene);
  EXPECT_LT(seen, most);
  EXPECT_GT(seen, 0.49 * most);
}

}  // namespace
}  // namespace cyanometer
