// Who may ask, for how long, and how much: token, CORS, deadlines, limits.
#include "server/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;

/// A daemon with settings of its own.
struct Configured {
  explicit Configured(const Config& config) : daemon(config) {
    daemon.start();
    wait_until_ready(daemon);
  }
  httplib::Result post(const json& scene, const httplib::Headers& headers = {},
                       const std::string& path = "/v1/render") {
    return client_of(daemon).Post(path.c_str(), headers, scene.dump(), "application/json");
  }
  httplib::Result get(const std::string& path, const httplib::Headers& headers = {}) {
    return client_of(daemon).Get(path.c_str(), headers);
  }
  Daemon daemon;
};

TEST(Token, IsAskedOfEverythingButProbes) {
  Config config = free_port();
  config.ops_listen = "127.0.0.1:0";
  config.token = "open sesame";
  Configured server(config);
  for (const auto* path : {"/v1/limits", "/", "/metrics", "/v1/nothing", "/v1/render"}) {
    const auto answer = server.get(path);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 401) << path;
    EXPECT_EQ(answer->get_header_value("WWW-Authenticate"), "Bearer");
  }
  for (const auto* given :
       {"Bearer open sesam", "Bearer open sesame ", "Bearer ", "open sesame",
        "Basic open sesame", "Bearer open sesameopen sesame", "bearer Open sesame", "bearer"}) {
    const auto answer = server.get("/v1/limits", {{"Authorization", given}});
    const bool trimmed = std::string(given) == "Bearer open sesame ";  // as HTTP trims it
    EXPECT_EQ(answer->status, trimmed ? 200 : 401) << given;
  }
  for (const auto* given : {"Bearer open sesame", "bearer open sesame", "BEARER open sesame"}) {
    EXPECT_EQ(server.get("/v1/limits", {{"Authorization", given}})->status, 200) << given;
  }
  EXPECT_EQ(server.get("/healthz")->status, 200);
  EXPECT_EQ(server.get("/readyz")->status, 200);
  httplib::Client ops("127.0.0.1", server.daemon.ops_port());
  EXPECT_EQ(ops.Get("/metrics")->status, 200);
}

TEST(Token, EqualTextsAreEqual) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const auto* other : {"", "ab", "abd", "abcabc", "abca", "Abc"}) {
    EXPECT_FALSE(equal_in_constant_time(other, "abc")) << other;
  }
}

TEST(Cors, IsOffUnlessConfigured) {
  const auto answer = client().Get("/v1/limits", {{"Origin", "https://there"}});
  EXPECT_FALSE(answer->has_header("Access-Control-Allow-Origin"));
}

TEST(Cors, LetsTheConfiguredOriginReadAnswers) {
  Config config = free_port();
  config.cors_origin = "https://there";
  config.token = "t";
  Configured server(config);
  const auto allowed = server.get("/v1/limits", {{"Origin", "https://there"}});
  EXPECT_EQ(allowed->get_header_value("Access-Control-Allow-Origin"), "https://there");
  EXPECT_EQ(allowed->get_header_value("Vary"), "Origin");
  const auto other = server.get("/v1/limits", {{"Origin", "https://elsewhere"}});
  EXPECT_FALSE(other->has_header("Access-Control-Allow-Origin"));
  httplib::Client browser = client_of(server.daemon);
  httplib::Request ask;
  ask.method = "OPTIONS";
  ask.path = "/v1/render";
  ask.headers = {{"Origin", "https://there"}, {"Access-Control-Request-Method", "POST"}};
  const auto preflight = browser.send(ask);
  ASSERT_TRUE(preflight);
  EXPECT_EQ(preflight->status, 204);
  for (const auto* name : {"Authorization", "Cyanometer-Atmosphere", "If-None-Match"}) {
    EXPECT_THAT(preflight->get_header_value("Access-Control-Allow-Headers"),
                ::testing::HasSubstr(name));
  }
}

TEST(Deadline, ARequestMayAskForAShorterOne) {
  const auto late = client().Post("/v1/render", {{"Cyanometer-Deadline", "0.2"}},
                                  long_scene().dump(), "application/json");
  ASSERT_TRUE(late);
  EXPECT_EQ(late->status, 504);
  const auto in_time = client().Post("/v1/render", {{"Cyanometer-Deadline", "60"}},
                                     small_scene().dump(), "application/json");
  EXPECT_EQ(in_time->status, 200);
}

TEST(Deadline, IsReadStrictly) {
  for (const auto& [given, status] : std::vector<std::pair<std::string, int>>{{"0", 400},
                                                                              {"-1", 400},
                                                                              {"soon", 400},
                                                                              {"nan", 400},
                                                                              {"inf", 400},
                                                                              {"1e400", 400},
                                                                              {"1s", 400},
                                                                              {"601", 422}}) {
    const auto answer = client().Post("/v1/render", {{"Cyanometer-Deadline", given}},
                                      small_scene().dump(), "application/json");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, status) << given;
    EXPECT_EQ(json_of(answer).at("given"), given);
  }
}

TEST(Limits, SamplesAreCounted) {
  Config config = free_port();
  config.max_samples = 1000;
  Configured server(config);
  const auto over = [&](const json& method) {
    return server.post({{"method", method}, {"image", {{"width", 8}, {"height", 8}}}});
  };
  const auto march = over({{"name", "nishita"}, {"view_samples", 100}, {"light_samples", 11}});
  EXPECT_EQ(march->status, 422) << march->body;
  EXPECT_EQ(json_of(march).at("pointer"), "/method/view_samples");
  const auto walks = over({{"name", "path"}, {"samples_per_pixel", 1001}});
  EXPECT_EQ(walks->status, 422);
  EXPECT_EQ(json_of(walks).at("pointer"), "/method/samples_per_pixel");
  EXPECT_EQ(over({{"name", "nishita"}, {"view_samples", 100}, {"light_samples", 10}})->status,
            200);
  EXPECT_EQ(json_of(server.get("/v1/limits")).at("samples"), 1000);
}

TEST(Limits, ExpectedTimeIsCounted) {
  Config config = free_port();
  config.max_device_s = 1;
  Configured server(config);
  const auto answer = server.post(long_scene());
  EXPECT_EQ(answer->status, 422);
  EXPECT_EQ(json_of(answer).at("pointer"), "/method");
  EXPECT_EQ(server.post(small_scene())->status, 200);
  const auto stream =
      server.post({{"scene", long_scene()}, {"refine", true}}, {}, "/v1/stream");
  EXPECT_EQ(stream->status, 422);
  EXPECT_EQ(json_of(server.get("/v1/limits")).at("device_s"), 1);
}

TEST(Limits, TheDefaultsLetThroughWhatTheContractNames) {
  for (const auto& scene : std::vector<json>{
           {{"image", {{"width", 4096}, {"height", 4096}}}},
           {{"method", {{"name", "nishita"}, {"view_samples", 2000}}}},
           {{"method", {{"name", "nishita"}, {"light_samples", 2000}}}},
           {{"method", {{"name", "nishita"}, {"view_samples", 256}, {"light_samples", 64}}},
            {"image", {{"width", 1920}, {"height", 1080}}}},
           {{"method", {{"name", "path"}, {"samples_per_pixel", 32768}}},
            {"image", {{"width", 36}, {"height", 36}}}}}) {
    // A short deadline tells what is let through (504) from what is refused (422).
    const auto answer = client().Post("/v1/render", {{"Cyanometer-Deadline", "1"}},
                                      scene.dump(), "application/json");
    ASSERT_TRUE(answer);
    EXPECT_THAT(answer->status, ::testing::AnyOf(200, 504)) << scene << answer->body;
  }
}

}  // namespace
}  // namespace cyanometer::testing
