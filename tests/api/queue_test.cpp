// The queue before the device: order, bounds, deadlines, clients that leave, devices that are
// lost.
#include "server/queue/render_queue.h"

#include <gtest/gtest.h>

#include <future>
#include <latch>

#include "engine/scene/document.h"
#include "server/queue/plans.h"
#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A job that holds the device until it is let go.
class Hold {
 public:
  explicit Hold(RenderQueue& queue) {
    thread_ = std::thread([this, &queue] {
      queue.run({.client = "holder", .work = [this](Engine&, const Watch&) {
                   started_.count_down();
                   release_.wait();
                 }});
    });
    started_.wait();
  }
  ~Hold() { let_go(); }
  void let_go() {
    if (!thread_.joinable()) return;
    release_.count_down();
    thread_.join();
  }

 private:
  std::latch started_{1}, release_{1};
  std::thread thread_;
};

void wait_for_depth(const RenderQueue& queue, std::size_t depth) {
  const auto end = Clock::now() + 10s;
  while (queue.depth() != depth && Clock::now() < end) std::this_thread::sleep_for(1ms);
  ASSERT_EQ(queue.depth(), depth);
}

std::vector<std::string> order_of(const std::vector<std::string>& clients) {
  RenderQueue queue({.warm = false});
  std::vector<std::string> order;
  std::vector<std::thread> threads;
  {
    Hold hold(queue);
    for (std::size_t i = 0; i < clients.size(); ++i) {
      threads.emplace_back([&queue, &order, client = clients[i]] {
        queue.run({.client = client,
                   .work = [&](Engine&, const Watch&) { order.push_back(client); }});
      });
      wait_for_depth(queue, i + 1);
    }
  }
  for (auto& thread : threads) thread.join();
  return order;
}

TEST(Queue, ClientsAlternate) {
  EXPECT_EQ(order_of({"a", "a", "a", "b", "c"}),
            (std::vector<std::string>{"a", "b", "c", "a", "a"}));
}

/// A job that works until it is told that it has done enough, looking up as methods do.
class Working {
 public:
  Working(RenderQueue& queue, double expected_ms) {
    thread_ = std::thread([this, &queue, expected_ms] {
      const Ticket ticket = queue.run({.client = "worker",
                                       .expected_ms = expected_ms,
                                       .work = [this](Engine&, const Watch& watch) {
                                         started_.count_down();
                                         while (!enough_) {
                                           watch.check();
                                           std::this_thread::sleep_for(1ms);
                                         }
                                       }});
      given_away_ms_ = ticket.given_away_ms;
    });
    started_.wait();
  }
  ~Working() { end(); }
  /// What it gave away to others, ms.
  double end() {
    enough_ = true;
    if (thread_.joinable()) thread_.join();
    return given_away_ms_;
  }

 private:
  std::latch started_{1};
  std::atomic<bool> enough_{false};
  double given_away_ms_ = 0;
  std::thread thread_;
};

std::future<void> run_later(RenderQueue& queue, double expected_ms,
                            std::chrono::milliseconds takes = 0ms) {
  return std::async(std::launch::async, [&queue, expected_ms, takes] {
    queue.run({.client = "short",
               .expected_ms = expected_ms,
               .work = [&](Engine&, const Watch&) { std::this_thread::sleep_for(takes); }});
  });
}

TEST(Queue, AShortJobIsDoneWhileALongOneRuns) {
  RenderQueue queue({.warm = false});
  Working working(queue, 60000);
  auto brief = run_later(queue, 100, 50ms);
  EXPECT_EQ(brief.wait_for(10s), std::future_status::ready);
  EXPECT_EQ(queue.counts().gave_way, 1u);
  EXPECT_GE(working.end(), 50);
}

TEST(Queue, AtItsStartAJobIsDoneWhileKernelsAreCompiledAhead) {
  RenderQueue queue({.warm = true});
  run_later(queue, 100).get();
  EXPECT_FALSE(queue.ready());
  EXPECT_EQ(queue.counts().gave_way, 1u);
}

Plans::Planned plan_of(Plans& plans, double sun_deg) {
  nlohmann::json scene = tiny_scene();
  scene["sun"] = {{"elevation_deg", sun_deg}};
  return plans.get(read_scene(scene), "client", {});
}

TEST(Plans, AreMadeOnce) {
  RenderQueue queue({.warm = false});
  Plans plans(queue);
  run_later(queue, 100).get();  // the device is there, and has its name
  const auto first = plan_of(plans, 30), again = plan_of(plans, 30);
  EXPECT_EQ(queue.counts().done, 2u);
  EXPECT_EQ(again.plan.expected_ms, first.plan.expected_ms);
  EXPECT_GT(first.ms, 0);
  EXPECT_EQ(again.ms, 0);
}

/// Before, at the first start on a device, they reckon with a nominal pace.
TEST(Plans, AreKeptFromWhenTheDeviceIsReady) {
  RenderQueue queue({.warm = true});
  Plans plans(queue);
  EXPECT_FALSE(plan_of(plans, 30).lasting);
  ASSERT_FALSE(queue.ready());
  plan_of(plans, 30);
  EXPECT_EQ(queue.counts().done, 2u);
}

TEST(Plans, WaitingIsNoPlanning) {
  RenderQueue queue({.warm = false});
  Plans plans(queue);
  Hold hold(queue);
  const auto start = Clock::now();
  auto planned = std::async(std::launch::async, [&] { return plan_of(plans, 30); });
  wait_for_depth(queue, 1);
  std::this_thread::sleep_for(300ms);
  hold.let_go();
  const auto got = planned.get();
  const double elapsed =
      std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  EXPECT_GE(got.queue_ms, 300);
  EXPECT_LE(got.queue_ms + got.ms, elapsed);
}

TEST(Queue, AJobOfTheSameLengthWaits) {
  RenderQueue queue({.warm = false});
  Working working(queue, 1000);
  auto other = run_later(queue, 500), unknown = run_later(queue, 0);
  EXPECT_EQ(other.wait_for(200ms), std::future_status::timeout);
  EXPECT_EQ(unknown.wait_for(0ms), std::future_status::timeout);
  EXPECT_EQ(working.end(), 0);
}

TEST(Queue, ShortJobsLeaveALongOneItsHalf) {
  RenderQueue queue({.warm = false});
  Working working(queue, 1e6);
  const auto start = Clock::now();
  std::vector<std::future<void>> brief;
  for (int i = 0; i < 5; ++i) brief.push_back(run_later(queue, 100, 40ms));
  for (auto& each : brief) each.wait();
  // Between five of 40 ms it has four times as long for itself.
  EXPECT_GE(Clock::now() - start, 9 * 40ms);
}

TEST(Queue, AJobThatGoesOnKeepsItsPlaceAndIsNotRefused) {
  RenderQueue queue({.capacity = 1, .warm = false});
  const auto nothing = [](Engine&, const Watch&) {};
  const Ticket plan = queue.run({.client = "a", .work = nothing});
  std::vector<std::string> order;
  std::vector<std::thread> threads;
  {
    Hold hold(queue);
    const auto add = [&](const std::string& client, std::optional<Place> place) {
      threads.emplace_back([&queue, &order, client, place] {
        queue.run({.client = client, .place = place, .work = [&](Engine&, const Watch&) {
                     order.push_back(client);
                   }});
      });
      wait_for_depth(queue, threads.size());
    };
    add("b", std::nullopt);
    add("a", plan.place);
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(order, (std::vector<std::string>{"a", "b"}));
}

TEST(Queue, OneClientLeavesPlacesForTheOthers) {
  RenderQueue queue({.capacity = 4, .warm = false});
  Hold hold(queue);
  std::vector<std::future<void>> waiting;
  for (std::size_t i = 1; i <= queue.share(); ++i) {
    waiting.push_back(run_later(queue, 0));
    wait_for_depth(queue, i);
  }
  try {
    queue.run({.client = "short", .work = [](Engine&, const Watch&) {}});
    ADD_FAILURE() << "one more than its share";
  } catch (const QueueFull& full) {
    EXPECT_EQ(full.whose, QueueFull::Whose::client);
    EXPECT_GE(full.retry_after_s, 1);
  }
  auto other = std::async(std::launch::async, [&] {
    queue.run({.client = "other", .work = [](Engine&, const Watch&) {}});
  });
  wait_for_depth(queue, queue.share() + 1);
  hold.let_go();
}

TEST(Queue, FramesAliveAreBounded) {
  RenderQueue queue({.frame_bytes = 100, .warm = false});
  const auto job = [](std::size_t bytes) {
    return Job{.client = "a", .frame_bytes = bytes, .work = [](Engine&, const Watch&) {}};
  };
  auto first = std::make_unique<Ticket>(queue.run(job(60)));
  auto second = std::async(std::launch::async, [&] { queue.run(job(60)); });
  EXPECT_EQ(second.wait_for(200ms), std::future_status::timeout);
  first.reset();
  EXPECT_EQ(second.wait_for(10s), std::future_status::ready);
}

TEST(Queue, WhatNeedsNoMemoryDoesNotWaitForThatOfOthers) {
  RenderQueue queue({.frame_bytes = 100, .warm = false});
  const auto job = [](std::size_t bytes) {
    return Job{.client = "a", .frame_bytes = bytes, .work = [](Engine&, const Watch&) {}};
  };
  auto being_sent = std::make_unique<Ticket>(queue.run(job(60)));
  auto large = std::async(std::launch::async, [&] { queue.run(job(60)); });
  wait_for_depth(queue, 1);
  auto small = std::async(std::launch::async, [&] { queue.run(job(10)); });
  auto plan = std::async(std::launch::async, [&] { queue.run(job(0)); });
  EXPECT_EQ(plan.wait_for(10s), std::future_status::ready);
  EXPECT_EQ(small.wait_for(200ms), std::future_status::timeout)
      << "it came before the large one";
  being_sent.reset();
  EXPECT_EQ(large.wait_for(10s), std::future_status::ready);
  EXPECT_EQ(small.wait_for(10s), std::future_status::ready);
}

TEST(Queue, AFullOneRefusesAndSaysWhenToComeBack) {
  Config config = free_port();
  config.queue = 1;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  auto& queue = daemon.service().queue;
  Hold hold(queue);
  auto waiting = std::async(std::launch::async, [&] {
    queue.run({.client = "a", .work = [](Engine&, const Watch&) {}});
  });
  wait_for_depth(queue, 1);
  const auto answer =
      client_of(daemon).Post("/v1/render", small_scene().dump(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 503);
  EXPECT_GE(std::stoi(answer->get_header_value("Retry-After")), 1);
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/problem+json");
  EXPECT_EQ(daemon.service().turned_away, 1u);
  EXPECT_EQ(client_of(daemon).Get("/healthz")->status, 200);
  hold.let_go();
}

TEST(SparingLog, WritesSoManyLinesASecondHoweverManyThereAre) {
  const auto start = std::chrono::steady_clock::now();
  SparingLog log("of a test");
  int written = 0;
  for (int i = 0; i < 1000; ++i) written += log.next();
  const auto seconds =
      std::chrono::ceil<std::chrono::seconds>(std::chrono::steady_clock::now() - start);
  EXPECT_GE(written, SparingLog::most_lines_per_s);
  EXPECT_LE(written, SparingLog::most_lines_per_s * (seconds.count() + 1));
}

/// A daemon whose device is held and whose queue is full of jobs of one client.
struct Full {
  Full(const Config& config, const std::string& client, std::size_t jobs) : daemon(config) {
    daemon.start();
    wait_until_ready(daemon);
    hold.emplace(daemon.service().queue);
    for (std::size_t i = 0; i < jobs; ++i) {
      waiting.push_back(std::async(std::launch::async, [this, client] {
        daemon.service().queue.run({.client = client, .work = [](Engine&, const Watch&) {}});
      }));
    }
    wait_for_depth(daemon.service().queue, jobs);
  }
  httplib::Result post(const nlohmann::json& scene, const httplib::Headers& headers = {}) {
    return client_of(daemon).Post("/v1/render", headers, scene.dump(), "application/json");
  }
  static Config with_places(int places) {
    Config config = free_port();
    config.queue = places;
    return config;
  }

  Daemon daemon;
  std::vector<std::future<void>> waiting;
  std::optional<Hold> hold;
};

TEST(Queue, AFullOneRefusesBeforeItReads) {
  Full full(Full::with_places(1), "a", 1);
  for (const auto* path : {"/v1/render", "/v1/radiance", "/v1/compare", "/v1/explain",
                           "/v1/attribute", "/v1/chart", "/v1/stream", "/v1/composite"}) {
    const auto answer = client_of(full.daemon).Post(path, "no scene", "application/json");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 503) << path;
    EXPECT_TRUE(answer->has_header("Retry-After")) << path;
  }
  EXPECT_EQ(full.daemon.service().turned_away, 8u);
  // What takes no place is answered, and said to be wrong, as ever.
  EXPECT_EQ(client_of(full.daemon).Post("/v1/optics", "no scene", "")->status, 400);
}

TEST(Queue, AFullOneAnswersWithAFrameThatWasKept) {
  auto& queue = shared_daemon().service().queue;
  const auto post = [](const nlohmann::json& scene) {
    return client().Post("/v1/render", scene.dump(), "application/json");
  };
  const auto first = post(small_scene());
  std::vector<std::future<void>> waiting;
  const Hold hold(queue);
  for (std::size_t i = 0; i < queue.capacity(); ++i) {
    waiting.push_back(std::async(std::launch::async, [&queue, i] {
      queue.run({.client = std::to_string(i), .work = [](Engine&, const Watch&) {}});
    }));
  }
  wait_for_depth(queue, queue.capacity());
  const auto again = post(small_scene());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 200);
  EXPECT_EQ(again->get_header_value("Cache-Status"), "cyanometer; hit");
  EXPECT_TRUE(again->body == first->body);
  auto other = small_scene();
  other["image"]["exposure_ev"] = 1;
  EXPECT_EQ(post(other)->status, 503);
}

TEST(Queue, AStreamThatWaitsForAPlaceIsNotTurnedAway) {
  Daemon daemon(Full::with_places(2));
  daemon.start();
  wait_until_ready(daemon);
  auto& queue = daemon.service().queue;
  client_of(daemon).Get("/v1/render?" + large_link + "&sun.elevation_deg=61");
  const auto before = queue.counts().done;
  RawClient reader(daemon.port());
  reader.send("GET /v1/stream?" + large_link +
              "&frames=12&to.sun.elevation_deg=60 HTTP/1.1\r\nHost: h\r\n\r\n");
  wait_until_still(queue, before);
  std::vector<std::future<void>> waiting;
  Hold hold(queue);
  for (std::size_t i = 0; i < queue.capacity(); ++i) {
    waiting.push_back(std::async(std::launch::async, [&queue, i] {
      queue.run({.client = std::to_string(i), .work = [](Engine&, const Watch&) {}});
    }));
  }
  wait_for_depth(queue, queue.capacity());
  std::string text = reader.receive(500ms);
  EXPECT_EQ(count(text, "Cyanometer-Frame: 12/12"), 0u);
  EXPECT_EQ(daemon.service().turned_away, 0u);
  hold.let_go();
  text += reader.receive(30s);
  EXPECT_EQ(count(text, "Cyanometer-Frame: 12/12"), 1u);
}

TEST(Queue, NumbersOfManyDirectionsCountAsFramesDo) {
  Config config = free_port();
  config.frame_memory_mb = 1;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  auto being_sent = daemon.service().queue.hold(config.frame_bytes());
  const nlohmann::json up{{"elevation_deg", 90}, {"azimuth_deg", 0}};
  const nlohmann::json body{{"scene", tiny_scene()}, {"directions", {up, up}}};
  const auto ask = [&](const std::string& deadline_s) {
    return client_of(daemon)
        .Post("/v1/radiance", {{"Cyanometer-Deadline", deadline_s}}, body.dump(),
              "application/json")
        ->status;
  };
  EXPECT_EQ(ask("0.3"), 504);
  being_sent.reset();
  EXPECT_EQ(ask("300"), 200);
}

TEST(Queue, BehindAProxyClientsHaveTheirOwnShares) {
  Config config = Full::with_places(4);
  config.trusted_proxy = "127.0.0.1";
  Full full(config, "203.0.113.1", 3);
  const auto asked_by = [&](const std::string& forwarded_for) {
    auto scene = small_scene();
    scene["image"]["exposure_ev"] = 2;
    return full
        .post(scene, {{"X-Forwarded-For", forwarded_for}, {"Cyanometer-Deadline", "0.2"}})
        ->status;
  };
  EXPECT_EQ(asked_by("203.0.113.1"), 429);
  EXPECT_EQ(asked_by("203.0.113.2"), 504);  // it had a place
  EXPECT_EQ(asked_by("203.0.113.2, 203.0.113.1"), 429);
}

TEST(Queue, WhoIsNoProxyIsNotBelieved) {
  Config config = Full::with_places(4);
  config.trusted_proxy = "192.0.2.0/24";
  Full full(config, "127.0.0.1", 3);
  auto scene = small_scene();
  scene["image"]["exposure_ev"] = 2;
  const auto answer =
      full.post(scene, {{"X-Forwarded-For", "203.0.113.1"}, {"Cyanometer-Deadline", "0.2"}});
  EXPECT_EQ(answer->status, 429);
}

TEST(Queue, ADeadlineEndsWaitingAndRenderingWith504) {
  Config config = free_port();
  config.deadline_s = 0.3;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  const auto render = [&](const nlohmann::json& scene) {
    return client_of(daemon).Post("/v1/render", scene.dump(), "application/json");
  };
  const auto start = Clock::now();
  const auto rendering = render(long_scene());
  ASSERT_TRUE(rendering);
  EXPECT_EQ(rendering->status, 504);
  EXPECT_LT(Clock::now() - start, 3s);
  Hold hold(daemon.service().queue);
  const auto waiting = render(small_scene());
  ASSERT_TRUE(waiting);
  EXPECT_EQ(waiting->status, 504);
  EXPECT_EQ(daemon.service().queue.counts().past_deadline, 2u);
}

/// Time from the client's leaving to the count of those who left.
Clock::duration time_to_notice(RenderQueue& queue, RawClient& raw) {
  const auto before = queue.counts().client_gone;
  const auto start = Clock::now();
  raw.close();
  while (queue.counts().client_gone == before && Clock::now() - start < 10s) {
    std::this_thread::sleep_for(1ms);
  }
  return Clock::now() - start;
}

std::string render_request(const nlohmann::json& scene) {
  const auto body = scene.dump();
  return "POST /v1/render HTTP/1.1\r\nHost: h\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

TEST(Queue, AClientThatLeavesFreesTheDevice) {
  auto& queue = shared_daemon().service().queue;
  RawClient raw;
  raw.send(render_request(long_scene()));
  std::this_thread::sleep_for(500ms);
  ASSERT_EQ(queue.depth(), 0u);
  const auto noticed = time_to_notice(queue, raw);
  RecordProperty("ms", static_cast<int>(noticed / 1ms));
  EXPECT_LT(noticed, 1s);
}

TEST(Queue, AClientThatLeavesFreesItsPlace) {
  auto& queue = shared_daemon().service().queue;
  auto scene = small_scene();
  scene["sun"] = {{"elevation_deg", 44.5}};
  client().Post("/v1/plan", scene.dump(), "application/json");
  Hold hold(queue);
  RawClient raw;
  raw.send(render_request(scene));
  wait_for_depth(queue, 1);
  EXPECT_LT(time_to_notice(queue, raw), 500ms);
  EXPECT_EQ(queue.depth(), 0u);
}

TEST(Queue, ProbesAreAnsweredWhileTheDeviceWorks) {
  Hold hold(shared_daemon().service().queue);
  const auto start = Clock::now();
  EXPECT_EQ(client().Get("/readyz")->status, 200);
  EXPECT_LT(Clock::now() - start, 500ms);
}

TEST(Queue, AKnownLinkIs304WhileTheDeviceWorks) {
  const auto* link = "/v1/render?image.width=16&image.height=8&sun.elevation_deg=7";
  const auto tag = client().Head(link)->get_header_value("ETag");
  Hold hold(shared_daemon().service().queue);
  EXPECT_EQ(status_of(get_if_changed(link, tag)), 304);
}

TEST(Queue, ALostDeviceIsMadeAgainAndTheJobRetriedOnce) {
  RenderQueue queue({.warm = false});
  int attempts = 0;
  queue.run({.client = "a", .work = [&](Engine& engine, const Watch&) {
               if (++attempts == 1) throw DeviceLost("as if");
               EXPECT_FALSE(engine.device().name.empty());
             }});
  EXPECT_EQ(attempts, 2);
  EXPECT_EQ(queue.counts().device_lost, 1u);
  EXPECT_TRUE(queue.ready());
}

TEST(Queue, ADeviceThatIsLostAgainAndAgainEndsTheProcess) {
  RenderQueue queue({.warm = false});
  const Job poison{.client = "a",
                   .work = [](Engine&, const Watch&) { throw DeviceLost("no"); }};
  EXPECT_THROW(queue.run(poison), DeviceUnavailable);
  EXPECT_FALSE(queue.failed());
  EXPECT_THROW(queue.run(poison), DeviceUnavailable);
  EXPECT_TRUE(queue.failed());
  EXPECT_EQ(queue.counts().device_lost, 4u);
  EXPECT_THROW(queue.run(poison), DeviceUnavailable);
}

TEST(Queue, ADeviceThatIsNotThereIsSaid) {
  RenderQueue queue({.engine = {.device = "no such device"}});
  EXPECT_THROW(queue.run({.client = "a", .work = [](Engine&, const Watch&) {}}),
               DeviceUnavailable);
  EXPECT_TRUE(queue.failed());
}

TEST(Queue, WhatAJobThrowsReachesItsClient) {
  RenderQueue queue({.warm = false});
  EXPECT_THROW(
      queue.run(
          {.client = "a",
           .work = [](Engine&, const Watch&) { throw OverLimit("/image/width", "too wide"); }}),
      OverLimit);
  EXPECT_TRUE(queue.ready());
}

TEST(Draining, WhatIsInFlightIsFinished) {
  Daemon daemon(free_port());
  daemon.start();
  wait_until_ready(daemon);
  auto hold = std::make_unique<Hold>(daemon.service().queue);
  auto answer = std::async(std::launch::async, [&] {
    return client_of(daemon).Post("/v1/render", small_scene().dump(), "application/json");
  });
  wait_for_depth(daemon.service().queue, 1);
  auto stopping = std::async(std::launch::async, [&] { daemon.stop(); });
  EXPECT_EQ(stopping.wait_for(200ms), std::future_status::timeout);
  EXPECT_FALSE(daemon.service().ready());
  hold.reset();
  const auto finished = answer.get();
  ASSERT_TRUE(finished);
  EXPECT_EQ(finished->status, 200);
  EXPECT_EQ(finished->get_header_value("Connection"), "close");
  EXPECT_EQ(stopping.wait_for(5s), std::future_status::ready);
}

}  // namespace
}  // namespace cyanometer::testing
