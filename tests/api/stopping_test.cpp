// Starting and stopping: who is told what, and that what is in flight is finished.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <future>
#include <thread>

#include "tests/api/client.h"
#include "tests/api/program.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

struct Told {
  int status = 0;
  std::string body = {};
};

Told told(int port, const std::string& path) {
  const auto answer = httplib::Client("127.0.0.1", port).Get(path);
  return answer ? Told{answer->status, answer->body} : Told{};
}

int status_of_frame(const Daemon& daemon, double exposure_ev) {
  json scene = tiny_scene();
  scene["image"]["exposure_ev"] = exposure_ev;
  const auto answer = client_of(daemon).Post("/v1/render", scene.dump(), "application/json");
  return answer ? answer->status : 0;
}

TEST(Starting, ItIsAliveButNotReadyUntilItsKernelsAre) {
  Config config = free_port();
  config.ops_listen = "127.0.0.1:0";
  config.warm = true;
  Daemon daemon(config);
  daemon.start();
  for (const int port : {daemon.port(), daemon.ops_port()}) {
    EXPECT_EQ(told(port, "/healthz").status, 200);
    const Told ready = told(port, "/readyz");
    EXPECT_EQ(ready.status, 503);
    EXPECT_THAT(ready.body, ::testing::HasSubstr("being prepared"));
    EXPECT_THAT(told(port, "/metrics").body, ::testing::HasSubstr("\ncyanometer_ready 0\n"));
  }
  EXPECT_EQ(status_of_frame(daemon, 0), 200) << "before that it waits for its own kernels";
}

TEST(Stopping, ItIsNotReadyAtOnceAndListensUntilItHasDrained) {
  Config config = free_port();
  config.ops_listen = "127.0.0.1:0";
  config.drain_s = 1.5;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  EXPECT_EQ(status_of_frame(daemon, 0), 200);
  EXPECT_EQ(told(daemon.ops_port(), "/readyz").status, 200);
  const auto start = Clock::now();
  auto stopped = std::async(std::launch::async, [&] { daemon.stop(); });
  std::this_thread::sleep_for(200ms);
  for (const int port : {daemon.port(), daemon.ops_port()}) {
    EXPECT_EQ(told(port, "/healthz").status, 200);
    const Told ready = told(port, "/readyz");
    EXPECT_EQ(ready.status, 503);
    EXPECT_THAT(ready.body, ::testing::HasSubstr("stopping"));
    EXPECT_THAT(told(port, "/metrics").body, ::testing::HasSubstr("\ncyanometer_ready 0\n"));
  }
  EXPECT_EQ(status_of_frame(daemon, 1), 200) << "who has not heard of it yet";
  stopped.get();
  EXPECT_GE(Clock::now() - start, 1500ms);
  for (const int port : {daemon.port(), daemon.ops_port()}) {
    EXPECT_EQ(told(port, "/healthz").status, 0) << "nobody listens";
  }
}

/// A client of a daemon that has asked, and nothing else.
struct Asking {
  Asking(int port, const std::string& target) : raw(port) {
    raw.send("GET " + target + " HTTP/1.1\r\nHost: h\r\n\r\n");
  }
  RawClient raw;
};

TEST(Serve, SigtermTruncatesNeitherLargeFramesNorStreams) {
  Program run({"serve", "--listen", "127.0.0.1:0"});
  const int port = run.port();
  const std::string quick = "method.name=raymarch&method.scattering_orders=1";
  Asking png(port, "/v1/render?image.width=1280&image.height=720&" + quick);
  Asking npy(port, "/v1/render?image.width=1024&image.height=1024&image.format=npy&" + quick);
  Asking stream(port,
                "/v1/stream?image.width=320&image.height=180&frames=8&"
                "to.sun.elevation_deg=60&" +
                    quick);
  std::this_thread::sleep_for(300ms);  // accepted, and for want of kernels not yet answered
  run.signal(SIGTERM);
  const std::string answers[] = {png.raw.receive(300s), npy.raw.receive(300s)};
  for (const std::string& answer : answers) {
    EXPECT_EQ(status_of(answer), 200);
    const auto head = answer.find("\r\n\r\n"), length = answer.find("Content-Length: ");
    ASSERT_LT(length, head);
    EXPECT_EQ(answer.size(), head + 4 + std::stoul(answer.substr(length + 16)));
  }
  const std::string frames = stream.raw.receive(300s);
  EXPECT_EQ(count(frames, "Cyanometer-Frame: "), 8u);
  EXPECT_TRUE(frames.ends_with("--frame--\r\n"));
  EXPECT_EQ(run.wait(), 0) << run.err();
}

}  // namespace
}  // namespace cyanometer::testing
