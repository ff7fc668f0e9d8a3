// What a load run says of a daemon whose answers are known.
#include "server/load/load.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

#include "server/load/daemon_time.h"
#include "tests/load/fake_daemon.h"

namespace cyanometer::testing {
namespace {

LoadSettings short_load(const FakeDaemon& daemon) {
  LoadSettings settings;
  settings.origin = daemon.origin();
  settings.clients = 2;
  settings.seconds = 0.2;
  return settings;
}

TEST(Load, AddsUpWhatFramesSayOfThemselves) {
  FakeDaemon daemon;
  const LoadReport report = run_load(short_load(daemon));
  const auto frames = static_cast<double>(daemon.frames);
  ASSERT_GE(daemon.frames, 4u);
  EXPECT_EQ(report.statuses, (std::map<int, std::size_t>{{200, daemon.frames}}));
  EXPECT_EQ(report.frame_ms.size(), daemon.frames);
  EXPECT_EQ(report.truncated, 1u);
  EXPECT_EQ(report.kept, 1u);
  EXPECT_EQ(report.unmet, daemon.frames / 2);
  EXPECT_NEAR(report.stated_error, 0.01 * (1 + 0.01 * (frames - 1)), 1e-6);
  EXPECT_EQ(report.methods, (std::set<std::string>{"fake grain=3"}));
  ASSERT_EQ(report.stage_ms.size(), 4u);
  for (const auto& [stage, ms] : report.stage_ms) EXPECT_EQ(ms.size(), daemon.frames) << stage;
  EXPECT_EQ(quantile(report.stage_ms.at("render"), 0.99), 3);
  EXPECT_EQ(quantile(report.stage_ms.at("queue"), 0), 0.5);
}

TEST(Load, NumbersGoOnFromTheFirst) {
  FakeDaemon daemon;
  LoadSettings settings = short_load(daemon);
  settings.first = 7000;
  run_load(settings);
  std::set<double> numbers;
  for (const auto& scene : daemon.scenes()) {
    numbers.insert(std::round(1e9 * scene.at("image").at("exposure_ev").get<double>()));
  }
  ASSERT_EQ(numbers.size(), daemon.frames);
  EXPECT_EQ(*numbers.begin(), 7000);
  EXPECT_EQ(*numbers.rbegin(), 7000 + static_cast<double>(daemon.frames) - 1);
}

TEST(Load, ThatVariesNothingAsksForTheSceneItself) {
  FakeDaemon daemon;
  LoadSettings settings = short_load(daemon);
  settings.vary = Variation::nothing;
  settings.scene = {{"preset", "nowhere"}};
  run_load(settings);
  for (const auto& scene : daemon.scenes()) EXPECT_EQ(scene, settings.scene);
}

TEST(Load, KnowsTheDaemonsTimeFromItsMetrics) {
  FakeDaemon daemon;
  daemon.cpu_s_a_frame = 0.25;
  daemon.token = "secret";
  LoadSettings settings = short_load(daemon);
  settings.token = "secret";
  const LoadReport report = run_load(settings);
  ASSERT_TRUE(report.daemon_cpu_s);
  EXPECT_NEAR(*report.daemon_cpu_s, 0.25 * static_cast<double>(daemon.frames), 1e-5);
  EXPECT_NEAR(load_document(report).at("frame_cpu_s"), 0.25, 1e-6);
}

TEST(Load, SaysNothingOfATimeThatItDoesNotKnow) {
  FakeDaemon daemon;
  const LoadReport report = run_load(short_load(daemon));
  EXPECT_FALSE(report.daemon_cpu_s);
  EXPECT_TRUE(load_document(report).at("frame_cpu_s").is_null());
}

TEST(Load, TakesTheTimeOfAProcessOfThisMachine) {
  FakeDaemon daemon;
  daemon.cpu_s_a_frame = 1000;
  LoadSettings settings = short_load(daemon);
  settings.daemon = getpid();  // generator and daemon at once
  const LoadReport report = run_load(settings);
  ASSERT_TRUE(report.daemon_cpu_s);
  EXPECT_GT(*report.daemon_cpu_s, 0);
  EXPECT_LT(*report.daemon_cpu_s, 64 * report.seconds + 1);
  EXPECT_FALSE(process_seconds((1 << 22) + 1));
}

TEST(Load, CountsWhatWasTurnedAwayBesideTheFrames) {
  FakeDaemon daemon;
  daemon.fail_after = 3;
  const LoadReport report = run_load(short_load(daemon));
  EXPECT_EQ(report.statuses.at(200), 3u);
  EXPECT_EQ(report.statuses.at(503), daemon.frames - 3);
  EXPECT_EQ(report.frame_ms.size(), 3u);
  EXPECT_EQ(report.reject_ms.size(), daemon.frames - 3);
  EXPECT_EQ(report.without_retry_after, 0u);
}

TEST(Load, AsksForAnotherPathWhereItIsTold) {
  FakeDaemon daemon;
  LoadSettings settings = short_load(daemon);
  settings.get = "/healthz";
  const LoadReport report = run_load(settings);
  EXPECT_EQ(daemon.frames, 0u);
  EXPECT_GT(report.statuses.at(200), 3u);
  EXPECT_TRUE(report.methods.empty());
}

TEST(Metric, IsReadByItsWholeName) {
  const std::string text = "# TYPE cpu counter\ncpu_total 1\ncpu{a=\"b\"} 2\ncpu 3.5e2\n";
  EXPECT_EQ(metric_of(text, "cpu"), 350);
  EXPECT_EQ(metric_of(text, "cpu_total"), 1);
  EXPECT_FALSE(metric_of(text, "cp"));
}

}  // namespace
}  // namespace cyanometer::testing
