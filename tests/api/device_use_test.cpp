// What of the device is in use, as operators see it: its memory, and compiled kernels within a
// bound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string post(const Daemon& daemon, const json& scene) {
  const auto answer = client_of(daemon).Post("/v1/render", scene.dump(), "application/json");
  EXPECT_TRUE(answer && answer->status == 200) << scene;
  return answer ? answer->body : "";
}

std::string metrics(const Daemon& daemon) { return client_of(daemon).Get("/metrics")->body; }

json plain_scene(int width) {
  json scene = small_scene();
  scene["image"]["width"] = width;
  scene["method"] = {{"name", "nishita"}, {"view_samples", 4}, {"light_samples", 2}};
  scene["spectrum"]["wavelengths_nm"] = {680, 550, 440};
  return scene;
}

TEST(DeviceUse, MemoryIsThatOfNowAndNotOfAFrameThatIsGone) {
  Config config = free_port();
  config.warm = false;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  const auto bytes_after = [&](int width) {
    post(daemon, plain_scene(width));
    const auto bytes = daemon.service().queue.device_use().bytes;
    EXPECT_THAT(metrics(daemon),
                HasSubstr("\ncyanometer_device_memory_bytes " + std::to_string(bytes) + "\n"));
    return bytes;
  };
  const auto after_a_large_frame = bytes_after(1024);
  EXPECT_EQ(bytes_after(16), after_a_large_frame);
}

TEST(DeviceUse, NoMoreKernelsAreKeptThanMayBeAndFramesComeOutTheSame) {
  Config config = free_port();
  config.warm = false;
  config.cache_mb = 0;  // or the last frame would be the first one, kept
  config.kernels = 24;  // a scene with its plan takes some twenty
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  std::map<std::string, std::string> frames;
  for (const auto* projection : {"perspective", "fisheye", "perspective"}) {
    json scene = plain_scene(16);
    scene["camera"]["projection"] = projection;
    const auto frame = post(daemon, scene);
    EXPECT_TRUE(frames.try_emplace(projection, frame).first->second == frame) << projection;
    const auto use = daemon.service().queue.device_use().kernels;
    EXPECT_LE(use.kept, 24u);
  }
  const auto compiled = daemon.service().queue.device_use().kernels.compiled;
  EXPECT_GT(compiled, 24u);
  for (const std::string& line :
       {std::string("cyanometer_kernels 24"), std::string("cyanometer_kernels_capacity 24"),
        "cyanometer_kernels_compiled_total " + std::to_string(compiled)}) {
    EXPECT_THAT(metrics(daemon), HasSubstr("\n" + line + "\n"));
  }
  EXPECT_EQ(json_of(client_of(daemon).Get("/v1/limits")).at("kernels"), 24);
}

}  // namespace
}  // namespace cyanometer::testing
