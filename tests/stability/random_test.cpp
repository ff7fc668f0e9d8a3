// Random scenes through every method.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/stability/any_scene.h"
#include "engine/stability/random_trials.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

/// None broken or refused, and no picture that changes faster than its scene.
void expect_sound(Engine& engine, std::uint64_t seed, const RandomTrialSettings& settings) {
  nlohmann::json trial = random_trial(engine, seed, settings);
  EXPECT_TRUE(trial.at("failures").empty()) << trial;
  EXPECT_TRUE(trial.at("refusals").empty()) << trial;
  if (!trial.contains("jumps")) return;
  for (const auto& [method, jump] : trial.at("jumps").items()) {
    const double least = jump <= 1 ? jump : trial.at("jumps_at_finest").at(method);
    EXPECT_LE(least, 1) << method << ": " << trial;
  }
}

nlohmann::json trial_of(int seed, const std::vector<std::string>& methods) {
  return {{"seed", seed},
          {"settings", settings_document({.methods = methods})},
          {"failures", nlohmann::json::array()},
          {"refusals", nlohmann::json::array()}};
}

TEST(RandomReport, CountsForEachMethodTheScenesThatItWasTriedOn) {
  const std::string report = random_report(
      {trial_of(0, {"raymarch"}), trial_of(1, {"raymarch", "path"}), trial_of(2, {})});
  EXPECT_NE(report.find("| `raymarch` | 3 | 0 |"), std::string::npos) << report;
  EXPECT_NE(report.find("| `path` | 2 | 0 |"), std::string::npos) << report;
  EXPECT_NE(report.find("| `moments` | 1 | 0 |"), std::string::npos) << report;
}

TEST(RandomScenes, SayWhatWasTriedOnThem) {
  const RandomTrialSettings asked{.methods = {"raymarch"}};
  const nlohmann::json trial = random_trial(device(), 0, asked);
  EXPECT_EQ(trial.at("settings"), settings_document(asked));
  EXPECT_EQ(trial.at("settings").at("methods"), nlohmann::json{"raymarch"});
  EXPECT_EQ(settings_document({}).at("methods").size(), methods().size());
  EXPECT_NE(settings_document({}), settings_document({.nudge = true}));
  EXPECT_NE(settings_document({}), settings_document({.options = TrialOptions::usual}));
}

/// The kernels of the scenes that are air and haze serve all of these, where enough are kept.
EngineOptions with_many_kernels() {
  EngineOptions options;
  options.kernels = EngineOptions::kernels_for_many_scenes;
  return options;
}

/// Half of the methods each, in turns; all where a number is changed, as what a change is worth
/// is told by what the others make of it. Few by settings that `auto` chooses among, which take
/// seconds. Of forms that are whatever a document can say two, and no changes, for their
/// kernels are compiled for that form alone and take most of the time.
RandomTrialSettings settings_of(std::uint64_t seed) {
  const std::uint64_t form = seed / scenes_of_a_form;
  const std::size_t count = methods().size();
  if (form % 4 == 3) {
    const std::size_t turn = form / 4, first = turn % count,
                      step = 1 + turn / count % (count - 1);
    return {.methods = {methods()[first].name, methods()[(first + step) % count].name}};
  }
  if (seed % 40 == 0) return {.nudge = true};
  RandomTrialSettings settings;
  if (seed % 201 == 99) settings.options = TrialOptions::ladder;
  for (std::size_t i = seed % 2; i < count; i += 2)
    settings.methods.push_back(methods()[i].name);
  return settings;
}

/// On one device, for most of the time its kernels are being made, which the scenes share.
TEST(RandomScenes, AreFiniteAndContinuousThroughTheSmallestTables) {
  Engine engine(with_many_kernels());
  for (std::uint64_t seed = 0; seed < 2000; ++seed)
    expect_sound(engine, seed, settings_of(seed));
}

/// A test each, so that processes can share them.
class RandomScene : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomScene, IsFiniteAndContinuousAtTheDefaults) {
  static Engine engine;
  expect_sound(engine, GetParam(),
               {.options = TrialOptions::usual, .nudge = GetParam() % 2 == 0});
}
INSTANTIATE_TEST_SUITE_P(RandomScenes, RandomScene, testing::Range<std::uint64_t>(0, 20));

}  // namespace
}  // namespace cyanometer
