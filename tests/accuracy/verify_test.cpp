// Plans that were verified: by random walks, not by the models that they choose from.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/accuracy/reference.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

TEST(Verify, StatesAnErrorThatAnIndependentReferenceFinds) {
  testing::TemporaryFolder folder;
  Engine& engine = device();
  for (double elevation : {60.0, 8.0}) {
    Scene scene = read_scene({{"sun", {{"elevation_deg", elevation}}},
                              {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                              {"image", {{"width", 64}, {"height", 36}}},
                              {"method", {{"verify", true}, {"max_error", 0.05}}}});
    Plan plan = engine.plan(scene);
    Reference reference = make_reference(engine, scene, {256, 0.005, 8192}, folder.path());
    auto values = engine.radiance(scene, reference.directions, false, plan).relative;
    EstimatedError error = measure_error(values, reference.halves[0], reference.halves[1]);
    // Two intervals of 95 % that know nothing of each other, of the same error.
    EXPECT_GE(plan.expected_error, error.low) << plan.why;
    EXPECT_LE(plan.expected_error, 2.5 * error.high) << plan.why;
    EXPECT_TRUE(plan.met) << plan.why;
  }
}

TEST(Verify, FindsWhatIsLeftOut) {
  Engine& engine = device();
  Scene scene = read_scene({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                            {"image", {{"width", 64}, {"height", 36}}},
                            {"method", {{"name", "raymarch"}, {"verify", true}}}});
  EXPECT_GT(engine.plan(scene).expected_error, 0.2);
}

// What tables make of a large sun, all further light from its middle, they have in common.
TEST(Verify, IsNotNeededForLargeSunsWhoseErrorWalksAloneTell) {
  json document{
      {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
      {"sun", {{"elevation_deg", -2}, {"angular_diameter_deg", 20}, {"disc_samples", 3}}},
      {"image", {{"width", 10}, {"height", 6}}},
      {"method", {{"name", "moments"}}}};
  const Plan plan = device().plan(read_scene(document));
  document["method"]["verify"] = true;
  const Plan verified = device().plan(read_scene(document));
  EXPECT_NEAR(plan.expected_error / verified.expected_error, 1, 0.1) << plan.why;
  EXPECT_GT(plan.expected_error, 0.05) << plan.why;
}

TEST(Radiance, ErrorsAreOfAllDirectionsAndNotOfTheFirst) {
  Scene scene = read_scene(
      {{"sun", {{"elevation_deg", 3}}},
       {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
       {"method", {{"name", "nishita"}, {"view_samples", 8}, {"light_samples", 4}}}});
  std::vector<Direction> up(300, Direction{88, 0}), low;
  for (int i = 0; i < 300; ++i) low.push_back({0.1 + 0.005 * i, 0.5 * i});
  const auto error_of = [&](std::vector<Direction> directions) {
    return device().radiance(scene, directions, false).plan.expected_error;
  };
  std::vector<Direction> all = up;
  all.insert(all.end(), low.begin(), low.end());
  std::vector<Direction> turned(all.rbegin(), all.rend());
  EXPECT_NEAR(error_of(all), error_of(turned), 0.05 * error_of(all));
  EXPECT_GT(std::abs(error_of(up) - error_of(low)), 0.1 * error_of(all));
}

TEST(Verify, LooksAtEnoughRaysOfAPlanetThatIsSmallInItsFrame) {
  Scene scene = read_scene({{"preset", "earth_disc"}});
  for (double fov_deg : {30.0, 90.0, 150.0}) {
    scene.camera.fov_deg = fov_deg;
    const std::size_t rays = sample_directions(scene, 256).size();
    EXPECT_GE(rays, 256u) << fov_deg;
    EXPECT_LE(rays, 400u) << fov_deg;
  }
  scene.image.width = 16;
  scene.image.height = 9;
  const auto all = measured_pixels(scene);
  EXPECT_EQ(std::ssize(sample_directions(scene, 256)), std::ranges::count(all, true));
}

}  // namespace
}  // namespace cyanometer
