// What the machine may do to the daemon: each has a defined answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;

struct Faulty {
  explicit Faulty(const EngineFaults& faults)
      : daemon([&] {
          Config config = free_port();
          config.faults = faults;
          return config;
        }()) {
    daemon.start();
    wait_until_ready(daemon);
  }
  httplib::Result render(const json& scene) {
    return client_of(daemon).Post("/v1/render", scene.dump(), "application/json");
  }
  Daemon daemon;
};

json march(int width) {
  return {{"method", {{"name", "raymarch"}}},
          {"image", {{"width", width}, {"height", width}, {"format", "npy"}}}};
}

TEST(Faults, ADeviceLostAtAnySubmissionIsMadeAgainAndTheFrameIsTheSame) {
  Faulty sound({});
  const auto wanted = sound.render(march(64));
  ASSERT_EQ(wanted->status, 200);
  for (const int n : {1, 2, 5}) {
    Faulty server({.lose_at_submission = n});
    // Planning takes some submissions; a few frames reach the n-th.
    for (int i = 0; i < 3; ++i) {
      const auto answer = server.render(march(64 + i));
      ASSERT_TRUE(answer);
      EXPECT_EQ(answer->status, 200) << n << answer->body;
      if (i == 0) {
        EXPECT_TRUE(answer->body == wanted->body) << n;
      }
    }
    EXPECT_EQ(server.daemon.service().queue.counts().device_lost, 1u) << n;
    EXPECT_TRUE(server.daemon.service().ready());
  }
}

TEST(Faults, ADeviceLostWhileAJobGaveWayIsMadeAgainForBoth) {
  Faulty server({});
  auto& queue = server.daemon.service().queue;
  std::atomic<bool> started = false, brief_done = false;
  std::atomic<int> long_runs = 0, brief_runs = 0;
  std::thread brief([&] {
    while (!started) std::this_thread::yield();
    queue.run({.client = "brief", .expected_ms = 1, .work = [&](Engine&, const Watch&) {
                 if (++brief_runs == 1) throw DeviceLost("as if");
                 brief_done = true;
               }});
  });
  queue.run({.client = "long", .expected_ms = 1e6, .work = [&](Engine& engine, const Watch& w) {
               ++long_runs;
               started = true;
               while (!brief_done) w.check();
               EXPECT_FALSE(engine.device().name.empty());
             }});
  brief.join();
  EXPECT_EQ(long_runs, 2);
  EXPECT_EQ(brief_runs, 2);
  EXPECT_EQ(queue.counts().device_lost, 1u);
  EXPECT_TRUE(queue.ready());
}

TEST(Faults, AFrameThatFindsNoMemoryIsToldToComeBackAndOthersGoOn) {
  Faulty server({.memory_bytes = 60u << 20});
  const auto large = server.render(march(2048));
  ASSERT_TRUE(large);
  EXPECT_EQ(large->status, 503) << large->body;
  EXPECT_TRUE(large->has_header("Retry-After"));
  EXPECT_EQ(server.daemon.service().queue.counts().out_of_memory, 1u);
  const auto small = server.render(march(64));
  ASSERT_TRUE(small);
  EXPECT_EQ(small->status, 200) << small->body;
  EXPECT_TRUE(server.daemon.service().ready());
}

TEST(Faults, TablesMakeRoomWhereMemoryIsShort) {
  Faulty server({.memory_bytes = 60u << 20});
  json scene{{"image", {{"width", 16}, {"height", 8}}}, {"method", {{"name", "moments"}}}};
  for (int i = 0; i < 4; ++i) {
    scene["planet"] = {{"ground_albedo", 0.01 * i}};
    const auto answer = server.render(scene);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->status, 200) << i << answer->body;
  }
  EXPECT_GE(server.daemon.service().queue.counts().out_of_memory, 1u);
}

}  // namespace
}  // namespace cyanometer::testing
