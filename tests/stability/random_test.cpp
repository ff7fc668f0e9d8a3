// Random scenes through every method.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

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

/// The kernels of the scenes that are air and haze serve all of these, where enough are kept.
EngineOptions with_many_kernels() {
  EngineOptions options;
  options.kernels = EngineOptions::kernels_for_many_scenes;
  return options;
}

/// Of each other form that is whatever a document can say two of the methods, for its kernels
/// are compiled for it alone and take most of the time.
RandomTrialSettings settings_of(std::uint64_t seed) {
  const std::uint64_t form = seed / scenes_of_a_form;
  if (form % 8 != 7) return {.nudge = seed % 40 == 0};
  const std::size_t count = methods().size(), first = form / 8 % count;
  return {.methods = {methods()[first].name, methods()[(first + 1 + form / 48) % count].name}};
}

/// Small tables keep one core busy: each has a device of its own, and takes the next form.
TEST(RandomScenes, AreFiniteAndContinuousThroughTheSmallestTables) {
  constexpr std::uint64_t forms = 2000 / scenes_of_a_form;
  std::atomic<std::uint64_t> next = 0;
  std::vector<std::jthread> threads(std::max(std::thread::hardware_concurrency(), 1u));
  for (std::jthread& thread : threads) {
    thread = std::jthread([&] {
      Engine engine(with_many_kernels());
      for (std::uint64_t form = next++; form < forms; form = next++) {
        for (std::uint64_t i = 0; i < scenes_of_a_form; ++i) {
          const std::uint64_t seed = form * scenes_of_a_form + i;
          expect_sound(engine, seed, settings_of(seed));
        }
      }
    });
  }
}

/// A test each, so that processes can share them.
class RandomScene : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomScene, IsFiniteAndContinuousAtTheDefaults) {
  static Engine engine;
  expect_sound(engine, GetParam(), {.usual_options = true, .nudge = GetParam() % 2 == 0});
}
INSTANTIATE_TEST_SUITE_P(RandomScenes, RandomScene, testing::Range<std::uint64_t>(0, 20));

}  // namespace
}  // namespace cyanometer
