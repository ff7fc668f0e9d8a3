// Equal frames: rendered once while in flight, kept for a while, within the bound of memory.
#include "server/queue/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <latch>
#include <set>

#include "engine/scene/document.h"
#include "engine/surface/maps.h"
#include "server/queue/plans.h"
#include "server/queue/single_flight.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using Flights = SingleFlight<int>;

std::string request_of(const json& scene) {
  const auto body = scene.dump();
  return "POST /v1/render HTTP/1.1\r\nHost: h\r\nConnection: close\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

json scene_at(double elevation_deg) {
  json scene = small_scene();
  scene["sun"] = {{"elevation_deg", elevation_deg}};
  return scene;
}

/// Some seconds of work.
json slow_scene(int samples) {
  return {{"method", {{"name", "nishita"}, {"view_samples", samples}, {"light_samples", 300}}},
          {"image", {{"width", 160}, {"height", 90}}}};
}

TEST(SingleFlight, TheFirstWorksForAll) {
  Flights flights;
  std::latch started(1), go(1);
  std::atomic<int> made = 0;
  const auto make = [&](const Watch&) {
    started.count_down();
    go.wait();
    return ++made;
  };
  auto first = std::async(std::launch::async, [&] { return flights.get("k", {}, make); });
  started.wait();
  auto second = std::async(std::launch::async, [&] { return flights.get("k", {}, make); });
  EXPECT_EQ(second.wait_for(100ms), std::future_status::timeout);
  go.count_down();
  EXPECT_EQ(*first.get().value, 1);
  const auto landed = second.get();
  EXPECT_EQ(*landed.value, 1);
  EXPECT_TRUE(landed.joined);
  EXPECT_EQ(*flights.get("k", {}, [&](const Watch&) { return 7; }).value, 7);
}

TEST(SingleFlight, WhoLeavesFreesNobodyElsesWork) {
  Flights flights;
  std::latch started(1);
  std::atomic<bool> first_left = false, second_left = false;
  Watch first_watch, second_watch;
  first_watch.gone = [&] { return first_left.load(); };
  second_watch.gone = [&] { return second_left.load(); };
  std::atomic<bool> done = false;
  const auto make = [&](const Watch& watch) {
    started.count_down();
    while (!done) {
      watch.check();
      std::this_thread::sleep_for(1ms);
    }
    return 1;
  };
  auto first =
      std::async(std::launch::async, [&] { return flights.get("k", first_watch, make); });
  started.wait();
  auto second =
      std::async(std::launch::async, [&] { return flights.get("k", second_watch, make); });
  std::this_thread::sleep_for(50ms);
  first_left = true;
  EXPECT_EQ(first.wait_for(200ms), std::future_status::timeout);
  done = true;
  EXPECT_EQ(*second.get().value, 1);

  // And when all have left, nobody works on.
  done = false;
  auto alone =
      std::async(std::launch::async, [&] { return flights.get("k", second_watch, make); });
  second_left = true;
  EXPECT_THROW(alone.get(), Cancelled);
}

TEST(SingleFlight, WhoHasMoreTimeThanTheFirstBeginsAgain) {
  Flights flights;
  std::latch started(1);
  Watch brief;
  brief.deadline = std::chrono::steady_clock::now() + 100ms;
  std::atomic<int> calls = 0;
  const auto make = [&](const Watch& watch) {
    if (++calls == 1) started.count_down();
    if (calls > 1) return 2;
    for (;;) {
      watch.check();
      std::this_thread::sleep_for(1ms);
    }
  };
  auto first = std::async(std::launch::async, [&] { return flights.get("k", brief, make); });
  started.wait();
  auto second = std::async(std::launch::async, [&] { return flights.get("k", {}, make); });
  EXPECT_THROW(first.get(), Cancelled);
  EXPECT_EQ(*second.get().value, 2);
}

TEST(SingleFlight, WhoseOwnShareIsNotUsedUpBeginsAgain) {
  Flights flights;
  std::latch started(1), go(1);
  std::atomic<int> calls = 0;
  const auto make = [&](const Watch&) -> int {
    if (++calls > 1) return 2;
    started.count_down();
    go.wait();
    throw QueueFull(QueueFull::Whose::client, 1);
  };
  auto first = std::async(std::launch::async, [&] { return flights.get("k", {}, make); });
  started.wait();
  auto second = std::async(std::launch::async, [&] { return flights.get("k", {}, make); });
  EXPECT_EQ(second.wait_for(100ms), std::future_status::timeout);
  go.count_down();
  EXPECT_THROW(first.get(), QueueFull);
  EXPECT_EQ(*second.get().value, 2);
}

TEST(Frames, EqualRequestsInFlightAreRenderedOnce) {
  auto& daemon = shared_daemon();
  const auto before = daemon.service().frames.counts();
  const auto scene = slow_scene(301);
  std::vector<std::future<httplib::Result>> answers;
  for (int i = 0; i < 8; ++i) {
    answers.push_back(std::async(std::launch::async, [&] {
      return client().Post("/v1/render", scene.dump(), "application/json");
    }));
  }
  std::set<std::string> bodies;
  for (auto& each : answers) {
    const auto answer = each.get();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
    bodies.insert(answer->body);
  }
  EXPECT_EQ(bodies.size(), 1u);
  EXPECT_EQ(daemon.service().frames.counts().rendered, before.rendered + 1);
}

TEST(Frames, AClientThatLeavesLeavesTheOthersTheirs) {
  RawClient leaver;
  leaver.send(request_of(slow_scene(302)));
  std::this_thread::sleep_for(200ms);
  auto stays = std::async(std::launch::async, [&] {
    return client().Post("/v1/render", slow_scene(302).dump(), "application/json");
  });
  std::this_thread::sleep_for(200ms);
  leaver.close();
  const auto answer = stays.get();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200) << answer->body;
}

TEST(Frames, AreKeptForTheNextRequest) {
  const auto scene = scene_at(11.25).dump();
  const auto first = client().Post("/v1/render", scene, "application/json");
  const auto again = client().Post("/v1/render", scene, "application/json");
  ASSERT_TRUE(again);
  EXPECT_EQ(first->get_header_value("Cache-Status"), "cyanometer; fwd=miss");
  EXPECT_EQ(again->get_header_value("Cache-Status"), "cyanometer; hit");
  EXPECT_EQ(again->body, first->body);
  for (const auto* name : {"ETag", "Cyanometer-Exposure", "Cyanometer-Error", "Content-Type"}) {
    EXPECT_EQ(again->get_header_value(name), first->get_header_value(name)) << name;
  }
}

TEST(Frames, ATimeBudgetIsNotKept) {
  json scene = scene_at(12.5);
  scene["method"] = {{"max_ms", 1000}};
  client().Post("/v1/render", scene.dump(), "application/json");
  const auto again = client().Post("/v1/render", scene.dump(), "application/json");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->get_header_value("Cache-Status"), "cyanometer; fwd=miss");
}

TEST(Frames, KeptOnesStayWithinTheirMemory) {
  Config config = free_port();
  config.cache_mb = 0.01;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  for (int i = 0; i < 8; ++i) {
    const auto answer =
        client_of(daemon).Post("/v1/render", scene_at(20 + 0.1 * i).dump(), "application/json");
    ASSERT_TRUE(answer);
    EXPECT_LE(daemon.service().frames.counts().kept_bytes, config.kept_frame_bytes());
  }
  EXPECT_GT(daemon.service().frames.counts().kept_bytes, 0u);
  const auto last =
      client_of(daemon).Post("/v1/render", scene_at(20.7).dump(), "application/json");
  EXPECT_EQ(last->get_header_value("Cache-Status"), "cyanometer; hit");
  const auto oldest =
      client_of(daemon).Post("/v1/render", scene_at(20).dump(), "application/json");
  EXPECT_EQ(oldest->get_header_value("Cache-Status"), "cyanometer; fwd=miss");
}

TEST(Frames, AKeptOneCountsOnceWhileItIsSent) {
  constexpr std::size_t most = std::size_t{1} << 20;
  RenderQueue queue({.frame_bytes = most, .warm = false});
  Frames frames(queue, most);
  const Scene scene = read_scene(tiny_scene());
  const Plan plan = Plans(queue).get(scene, "a", {}).plan;
  const auto get = [&] {
    return frames.get({.scene = scene, .plan = plan, .tag = "tag", .client = "a"}, {});
  };
  const auto wanting = [&](std::size_t bytes) {
    return std::async(std::launch::async, [&queue, bytes] {
      queue.run({.client = "a", .frame_bytes = bytes, .work = [](Engine&, const Watch&) {}});
    });
  };
  get();
  auto one = get(), other = get();
  EXPECT_EQ(one.origin, Frames::Origin::kept);
  auto rest = wanting(most - one.frame->bytes.size());
  EXPECT_EQ(rest.wait_for(10s), std::future_status::ready);
  auto all = wanting(most);
  EXPECT_EQ(all.wait_for(200ms), std::future_status::timeout);
  one.memory.reset();
  EXPECT_EQ(all.wait_for(200ms), std::future_status::timeout);
  other.memory.reset();
  EXPECT_EQ(all.wait_for(10s), std::future_status::ready);
}

TEST(Frames, AShortOneDoesNotWaitForALongOne) {
  const auto& queue = shared_daemon().service().queue;
  client().Post("/v1/plan", scene_at(33).dump(), "application/json");
  auto patient = std::make_optional<RawClient>();
  patient->send(request_of(long_scene()));
  for (int i = 0; i < 3000 && !queue.busy(); ++i) std::this_thread::sleep_for(10ms);
  ASSERT_TRUE(queue.busy());
  // At first it may be planned yet.
  for (int i = 0; i < 100 && queue.counts().gave_way == 0; ++i) {
    json scene = scene_at(33);
    scene["image"]["exposure_ev"] = 0.01 * i;
    const auto answer = client().Post("/v1/render", scene.dump(), "application/json");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_GE(queue.counts().gave_way, 1u);
  EXPECT_TRUE(queue.busy()) << "the long one goes on";
  patient.reset();
  for (int i = 0; i < 3000 && queue.busy(); ++i) std::this_thread::sleep_for(10ms);
}

/// Interrupting may not change what is interrupted.
TEST(Frames, ALongOneIsTheSameWhateverWasDoneInBetween) {
  Config config = free_port();
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  const auto render = [&](const json& each) {
    return client_of(daemon).Post("/v1/render", each.dump(), "application/json");
  };
  const auto gave_way = [&] { return daemon.service().queue.counts().gave_way; };
  for (json method :
       std::vector<json>{{{"name", "nishita"}, {"view_samples", 300}, {"light_samples", 40}},
                         {{"name", "raymarch"}, {"view_nodes", 32}},
                         {{"name", "moments"}, {"march_pixels", 1}},
                         {{"name", "path"}, {"samples_per_pixel", 8}}}) {
    json scene{{"method", method},
               {"image", {{"width", 160}, {"height", 90}, {"format", "npy"}}}};
    if (method["name"] == "raymarch") scene["image"] = {{"width", 640}, {"format", "npy"}};
    if (method["name"] == "moments") scene["image"]["width"] = 480;
    const auto alone = client().Post("/v1/render", scene.dump(), "application/json");
    json small = scene;
    small["image"] = {{"width", 9}, {"height", 5}, {"format", "npy"}};
    // Tables are a large part of a small frame of moments: in their place, what they begin
    // with.
    if (method["name"] == "moments") small["method"] = {{"name", "raymarch"}};
    render(small);  // planning takes longer than such a frame
    const auto before = gave_way();
    auto disturbed = std::async(std::launch::async, [&] { return render(scene); });
    for (int i = 0; disturbed.wait_for(0ms) != std::future_status::ready && i < 100 &&
                    gave_way() < before + 3;
         ++i) {
      small["sun"] = {{"elevation_deg", 30 + 0.01 * i}};
      render(small);
    }
    const auto answer = disturbed.get();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body.substr(0, 300);
    EXPECT_TRUE(answer->body == alone->body) << method;
    EXPECT_GT(gave_way(), before) << method;
  }
}

TEST(Frames, OverAMapAreOthersOnceItsFileIsAnother) {
  TemporaryFolder folder;
  Config config = free_port();
  config.surfaces = folder.path();
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  auto post = [&](const json& scene) {
    return client_of(daemon).Post("/v1/render", scene.dump(), "application/json");
  };
  auto paint = [&](double sun_deg) {
    std::ofstream(folder / "world.png", std::ios::binary) << post(scene_at(sun_deg))->body;
  };
  json scene = scene_at(40);
  scene["planet"]["surface"] = {{"type", "map"}, {"albedo", "world.png"}};
  scene["camera"]["pitch_deg"] = -90;
  scene["method"] = {{"name", "raymarch"}};
  paint(60);
  const auto before = post(scene);
  ASSERT_EQ(before->status, 200) << before->body;
  EXPECT_EQ(post(scene)->get_header_value("Cache-Status"), "cyanometer; hit");
  paint(-3);
  const auto done = daemon.service().queue.counts().done;
  const auto after = post(scene);
  EXPECT_EQ(daemon.service().queue.counts().done, done + 2) << "its plan too";
  EXPECT_EQ(after->get_header_value("Cache-Status"), "cyanometer; fwd=miss");
  EXPECT_NE(after->get_header_value("ETag"), before->get_header_value("ETag"));
  EXPECT_NE(after->body, before->body);
  // The tests after this have no folder, as those before it.
  use_surfaces({}, std::size_t{64} << 20);
}

}  // namespace
}  // namespace cyanometer::testing
