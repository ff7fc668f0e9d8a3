// Plans that were verified: by random walks, not by the models that they choose from.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/accuracy/reference.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

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
    auto values = engine.radiance(scene, reference.directions, false, plan).radiance;
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

}  // namespace
}  // namespace cyanometer
