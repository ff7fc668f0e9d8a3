// Random scenes through every method.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/stability/random_trials.h"

namespace cyanometer {
namespace {

/// None broken or refused, and no picture that changes faster than its scene.
void expect_sound(int scenes, const RandomTrialSettings& settings, int nudge_each) {
  Engine engine;
  for (int seed = 0; seed < scenes; ++seed) {
    RandomTrialSettings each = settings;
    each.nudge = seed % nudge_each == 0;
    nlohmann::json trial = random_trial(engine, static_cast<std::uint64_t>(seed), each);
    EXPECT_TRUE(trial.at("failures").empty()) << trial;
    EXPECT_TRUE(trial.at("refusals").empty()) << trial;
    if (!trial.contains("jumps")) continue;
    for (const auto& [method, jump] : trial.at("jumps").items())
      EXPECT_LE(jump.get<double>(), 1) << method << ": " << trial;
  }
}

TEST(RandomScenes, AreFiniteAndContinuousThroughTheSmallestTables) {
  expect_sound(2000, {}, 40);
}

TEST(RandomScenes, AreFiniteAndContinuousAtTheDefaults) {
  expect_sound(20, {.usual_options = true}, 2);
}

}  // namespace
}  // namespace cyanometer
