// Random scenes through every method.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/stability/any_scene.h"
#include "engine/stability/random_trials.h"

namespace cyanometer {
namespace {

/// None broken or refused, and no picture that changes faster than its scene.
void expect_sound(Engine& engine, std::uint64_t seed, const RandomTrialSettings& settings) {
  nlohmann::json trial = random_trial(engine, seed, settings);
  EXPECT_TRUE(trial.at("failures").empty()) << trial;
  EXPECT_TRUE(trial.at("refusals").empty()) << trial;
  if (!trial.contains("jumps")) return;
  for (const auto& [method, jump] : trial.at("jumps").items())
    EXPECT_LE(jump.get<double>(), 1) << method << ": " << trial;
}

/// Two of the methods for a form of scenes, for kernels that are compiled for it take most of
/// the time; of some forms all of them, and those are nudged.
TEST(RandomScenes, AreFiniteAndContinuousThroughTheSmallestTables) {
  Engine engine;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    std::uint64_t form = seed / scenes_of_a_form;
    RandomTrialSettings settings;
    bool by_all = form % 7 == 0;
    settings.nudge = by_all && seed % 5 == 0;
    if (!by_all) {
      settings.methods = {methods()[form % methods().size()].name,
                          methods()[(form + 1 + form / 6 % 5) % methods().size()].name};
    }
    expect_sound(engine, seed, settings);
  }
}

TEST(RandomScenes, AreFiniteAndContinuousAtTheDefaults) {
  Engine engine;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    expect_sound(engine, seed, {.usual_options = true, .nudge = seed % 2 == 0});
}

}  // namespace
}  // namespace cyanometer
