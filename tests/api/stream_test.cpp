// /v1/stream: frames in their order, each saying which it is and how wrong; readers that are
// slow or leave; refusals before the first frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "engine/scene/document.h"
#include "server/routes/frame_patches.h"
#include "server/routes/steady_plans.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

const std::string tiny =
    "image.width=16&image.height=8&method.name=raymarch&method.scattering_orders=1";

struct Part {
  std::string head, body;
  std::string field(const std::string& name) const {
    const auto at = head.find(name + ": ");
    if (at == std::string::npos) return "";
    const auto begin = at + name.size() + 2;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

/// The parts of a body, which must be well formed to its closing boundary.
std::vector<Part> parts_of(const std::string& body) {
  std::vector<Part> parts;
  std::size_t at = 0;
  const auto skip = [&](const std::string& text) {
    EXPECT_EQ(body.substr(at, text.size()), text);
    at += text.size();
  };
  skip("--frame");
  while (at + 2 < body.size() && body.compare(at, 2, "--") != 0) {
    skip("\r\n");
    const auto end = body.find("\r\n\r\n", at);
    if (end == std::string::npos) break;
    Part part{body.substr(at, end + 2 - at), ""};
    at = end + 4;
    const auto length = part.field("Content-Length");
    if (length.empty()) break;
    part.body = body.substr(at, std::stoul(length));
    at += part.body.size();
    parts.push_back(part);
    skip("\r\n--frame");
  }
  skip("--\r\n");
  EXPECT_EQ(at, body.size());
  return parts;
}

httplib::Result get_stream(const std::string& query, const httplib::Headers& headers = {}) {
  return client().Get("/v1/stream?" + query, headers);
}

httplib::Result post_stream(const json& body, const httplib::Headers& headers = {}) {
  return client().Post("/v1/stream", headers, body.dump(), "application/json");
}

TEST(Stream, ASweepIsTheFramesOfItsScenes) {
  const auto answer =
      get_stream(tiny + "&frames=5&to.sun.elevation_deg=-6&sun.elevation_deg=2");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_THAT(answer->get_header_value("Content-Type"),
              ::testing::StartsWith("multipart/x-mixed-replace; boundary="));
  EXPECT_EQ(answer->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(answer->get_header_value("X-Accel-Buffering"), "no");
  const auto parts = parts_of(answer->body);
  ASSERT_EQ(parts.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const auto& part = parts[static_cast<std::size_t>(i)];
    EXPECT_EQ(part.field("Cyanometer-Frame"), std::to_string(i + 1) + "/5");
    EXPECT_EQ(part.field("Content-Type"), "image/png");
    EXPECT_GE(std::stod(part.field("Cyanometer-Error")), 0);
    EXPECT_FALSE(part.field("Server-Timing").empty());
    json scene = tiny_scene();
    scene["sun"] = {{"elevation_deg", 2 - 2 * i}};
    EXPECT_EQ(part.body, client().Post("/v1/render", scene.dump(), "application/json")->body);
  }
}

TEST(Stream, ASweepStartsAtWhatTheSceneHas) {
  const auto parts = parts_of(get_stream(tiny + "&frames=2&to.sun.elevation_deg=10")->body);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].body,
            client().Post("/v1/render", tiny_scene().dump(), "application/json")->body);
}

TEST(Stream, ABodySweepsAsALinkDoes) {
  const json sweep{{"scene", tiny_scene()}, {"frames", 3}, {"to", {{"sun.elevation_deg", -6}}}};
  const auto answer = post_stream(sweep);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const auto parts = parts_of(answer->body);
  const auto linked = parts_of(get_stream(tiny + "&frames=3&to.sun.elevation_deg=-6")->body);
  ASSERT_EQ(parts.size(), 3u);
  ASSERT_EQ(linked.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(parts[i].body, linked[i].body) << i;
}

TEST(Stream, FramesAreMergedIntoTheScene) {
  const json patches{json::object(), {{"sun", {{"elevation_deg", 5}}}}, {{"preset", "mars"}}};
  const auto answer = post_stream({{"scene", tiny_scene()}, {"frames", patches}});
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const auto parts = parts_of(answer->body);
  ASSERT_EQ(parts.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const json scene = merge(tiny_scene(), patches[i]);
    EXPECT_EQ(parts[i].body,
              client().Post("/v1/render", scene.dump(), "application/json")->body)
        << i;
  }
}

TEST(Stream, PatchesMayLeaveTheirTypesToThePreset) {
  const auto hazy = [](const json& aerosol) {
    return json{{"atmosphere", {{"constituents", {{"aerosol", aerosol}}}}}};
  };
  const json patch = hazy({{"visibility_km", 10}});
  const auto answer = post_stream(
      {{"scene", merge(tiny_scene(), hazy({{"optical_depth", 0.2}}))}, {"frames", {patch}}});
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(
      parts_of(answer->body).at(0).body,
      client().Post("/v1/render", merge(tiny_scene(), patch).dump(), "application/json")->body);
}

TEST(Stream, ARefinementGetsBetterAndEndsWithTheScene) {
  json scene = small_scene();
  scene["method"] = {{"name", "path"}, {"samples_per_pixel", 64}};
  for (const auto& answer :
       {post_stream({{"scene", scene}, {"refine", true}}),
        get_stream("image.width=16&image.height=8&method.name=path&method.samples_per_pixel=64"
                   "&refine=true")}) {
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->status, 200) << answer->body;
    const auto parts = parts_of(answer->body);
    ASSERT_EQ(parts.size(), 4u);
    double before = 2;
    for (const auto& part : parts) {
      const double error = std::stod(part.field("Cyanometer-Error"));
      EXPECT_LT(error, before);
      before = error;
    }
    EXPECT_EQ(parts.back().field("Cyanometer-Frame"), "4/4");
    EXPECT_EQ(parts.back().body,
              client().Post("/v1/render", scene.dump(), "application/json")->body);
  }
}

TEST(Stream, ARefinementOfAutoEndsWithTheScene) {
  const auto answer = get_stream("image.width=64&image.height=36&refine=true");
  ASSERT_TRUE(answer);
  const auto parts = parts_of(answer->body);
  ASSERT_FALSE(parts.empty());
  EXPECT_EQ(parts.back().field("Cyanometer-Frame"), "4/4");
  EXPECT_EQ(parts.back().body, client().Get("/v1/render?image.width=64&image.height=36")->body);
}

TEST(Stream, PicturesAreWhatImgTakes) {
  for (const auto* accept : {"image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8",
                             "multipart/x-mixed-replace", "*/*"}) {
    const auto answer =
        get_stream(tiny + "&frames=1&to.sun.elevation_deg=1", {{"Accept", accept}});
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->status, 200) << answer->body;
    EXPECT_EQ(parts_of(answer->body).at(0).field("Content-Type"), "image/png") << accept;
  }
  const auto jpeg = get_stream(tiny + "&image.format=jpeg&frames=1&to.sun.elevation_deg=1");
  EXPECT_EQ(parts_of(jpeg->body).at(0).field("Content-Type"), "image/jpeg");
}

TEST(Stream, LinksAreReadStrictly) {
  for (const auto& [query, pointer] : std::vector<std::pair<std::string, std::string>>{
           {"", ""},
           {"frames=3&refine=true&to.sun.elevation_deg=1", ""},
           {"frames=3", "/to"},
           {"frames=0&to.sun.elevation_deg=1", "/frames"},
           {"frames=2.5&to.sun.elevation_deg=1", "/frames"},
           {"frames=x&to.sun.elevation_deg=1", "/frames"},
           {"frames=3&frames=3&to.sun.elevation_deg=1", "/frames"},
           {"refine=1", "/refine"},
           {"refine=true&to.sun.elevation_deg=1", "/to.sun.elevation_deg"},
           {"frames=3&to.sun.elevation_deg=up", "/to.sun.elevation_deg"},
           {"frames=3&to.sun.elevation_deg=1e400", "/to.sun.elevation_deg"},
           {"frames=3&to.sun.elevation_deg=1&to.sun.elevation_deg=2", "/to.sun.elevation_deg"},
           {"frames=3&to.sun.height=1", "/to.sun.height"},
           {"frames=3&to.image.format=1", "/to.image.format"},
           {"frames=3&to.=1", "/to."},
           {"frames=3&to.sun.elevation_deg=100", "/to.sun.elevation_deg"},
           {"frames=3&to.sun.elevation_deg=1&planet.radius_km=-1", "/planet/radius_km"}}) {
    const auto answer = get_stream(query);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 400) << query << answer->body;
    EXPECT_EQ(json_of(answer).value("pointer", ""), pointer) << query;
  }
  EXPECT_NE(get_stream("frames=3&to.sun.elevation_deg=900")->body.find("not 900"),
            std::string::npos);
  EXPECT_EQ(get_stream("frames=3601&to.sun.elevation_deg=1")->status, 422);
  EXPECT_EQ(get_stream("frames=1e300&to.sun.elevation_deg=1")->status, 400);
}

TEST(Stream, BodiesAreReadStrictly) {
  const json low{{"sun", {{"elevation_deg", -100}}}};
  const json wide{{"image", {{"width", 8192}, {"height", 4096}}}};
  for (const auto& [body, status, pointer] : std::vector<std::tuple<json, int, std::string>>{
           {json::object(), 400, ""},
           {json::array(), 400, ""},
           {{{"frames", json::array()}}, 400, "/frames"},
           {{{"frames", {3}}}, 400, "/frames/0"},
           {{{"frames", "3"}}, 400, "/frames"},
           {{{"frames", 3}}, 400, "/to"},
           {{{"frames", 0}, {"to", {{"sun.elevation_deg", 1}}}}, 400, "/frames"},
           {{{"frames", 3}, {"to", 1}}, 400, "/to"},
           {{{"frames", 3}, {"to", {{"sun.height", 1}}}}, 400, "/to/sun.height"},
           {{{"frames", 3}, {"to", {{"sun.elevation_deg", -100}}}},
            400,
            "/to/sun.elevation_deg"},
           {{{"frames", 3}, {"to", {{"camera.pitch_deg", 5}, {"sun.elevation_deg", -100}}}},
            400,
            "/to/sun.elevation_deg"},
           // The sun would be within the air.
           {{{"scene", {{"sun", {{"distance_km", 6600}}}}},
             {"frames", 3},
             {"to", {{"planet.radius_km", 6700}}}},
            400,
            "/to/planet.radius_km"},
           {{{"frames", 3}, {"to", {{"image.width", 1281}}}}, 400, "/to/image.width"},
           {{{"scene", wide}, {"frames", 3}, {"to", {{"image.width", 16}}}},
            422,
            "/scene/image/width"},
           {{{"frames", 3}, {"to", {{"image.height", 16384}}}}, 422, "/to/image.height"},
           {{{"frames", 3}, {"to", {{"sun.elevation_deg", "1"}}}},
            400,
            "/to/sun.elevation_deg"},
           {{{"frames", 3}, {"to", {{"spectrum.wavelengths_nm.0", 500}}}},
            400,
            "/to/spectrum.wavelengths_nm.0"},
           {{{"frames", {json::object()}}, {"to", {{"sun.elevation_deg", 1}}}}, 400, "/to"},
           {{{"refine", true}, {"to", {{"sun.elevation_deg", 1}}}}, 400, "/to"},
           {{{"frames", 3601}, {"to", {{"sun.elevation_deg", 1}}}}, 422, "/frames"},
           {{{"refine", false}}, 400, "/refine"},
           {{{"refine", true}, {"more", 1}}, 400, "/more"},
           {{{"scene", 3}, {"refine", true}}, 400, "/scene"},
           {{{"scene", low}, {"refine", true}}, 400, "/scene/sun/elevation_deg"},
           {{{"scene", low}, {"frames", {json::object()}}}, 400, "/scene/sun/elevation_deg"},
           {{{"frames", {json::object(), low}}}, 400, "/frames/1/sun/elevation_deg"},
           {{{"frames", {json::object(), wide}}}, 422, "/frames/1/image/width"},
           {{{"scene", wide}, {"refine", true}}, 422, "/scene/image/width"}}) {
    const auto answer = post_stream(body);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, status) << body << answer->body;
    EXPECT_EQ(json_of(answer).value("pointer", ""), pointer) << body;
  }
}

json planet_with_relief(double km) {
  return {{"planet", {{"surface", {{"type", "procedural"}, {"relief_km", km}}}}}};
}

/// Peaks that stand out of the air are found when the frame is planned.
TEST(Stream, WhatOnlyWorkFindsIsPointedToInTheRequest) {
  const json high = merge(tiny_scene(), planet_with_relief(100));
  const json flat = merge(tiny_scene(), planet_with_relief(0));
  const std::string relief = "/planet/surface/relief_km";
  for (const auto& [body, pointer] : std::vector<std::pair<json, std::string>>{
           {{{"scene", high}, {"refine", true}}, "/scene" + relief},
           {{{"scene", high}, {"frames", 2}, {"to", {{"sun.elevation_deg", 5}}}},
            "/scene" + relief},
           {{{"scene", tiny_scene()}, {"frames", {planet_with_relief(100)}}},
            "/frames/0" + relief}}) {
    const auto answer = post_stream(body);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 400) << body << answer->body;
    EXPECT_EQ(json_of(answer).value("pointer", ""), pointer) << body;
  }
  const auto link = get_stream(
      tiny + "&planet.surface.type=procedural&planet.surface.relief_km=100&refine=true");
  EXPECT_EQ(json_of(link).value("pointer", ""), relief);

  const auto sweep = post_stream(
      {{"scene", flat}, {"frames", 2}, {"to", {{"planet.surface.relief_km", 100}}}});
  ASSERT_TRUE(sweep);
  const auto parts = parts_of(sweep->body);
  ASSERT_EQ(parts.size(), 2u) << sweep->body;
  EXPECT_EQ(parts[1].field("Content-Type"), "application/problem+json");
  EXPECT_EQ(json::parse(parts[1].body).value("pointer", ""), "/to/planet.surface.relief_km");
}

/// Frames are made ahead, so the third may have failed before the first was taken.
TEST(Stream, FramesBeforeOneThatCannotBeMadeAllCome) {
  const json ok = json::object(), bad = planet_with_relief(100);
  const auto answer = post_stream({{"scene", tiny_scene()}, {"frames", {ok, ok, bad, ok, ok}}});
  ASSERT_TRUE(answer);
  const auto parts = parts_of(answer->body);
  ASSERT_EQ(parts.size(), 3u) << answer->body;
  EXPECT_EQ(parts[0].field("Cyanometer-Frame"), "1/5");
  EXPECT_EQ(parts[1].field("Cyanometer-Frame"), "2/5");
  EXPECT_EQ(json::parse(parts[2].body).value("pointer", ""),
            "/frames/2/planet/surface/relief_km");
}

const json summer_noon{
    {"sun",
     {{"place",
       {{"latitude_deg", 48.5}, {"longitude_deg", 2.5}, {"time", "2024-06-20T12:00:00Z"}}}}}};

TEST(Stream, ASweepOfAnAngleKeepsTheOtherAndTheFootPointOfAPlace) {
  const auto sweep = read_sweep(summer_noon, 3, {{"sun.elevation_deg", 10}}, "/to/", "");
  const Scene start = read_scene(summer_noon);
  EXPECT_EQ(read_scene(summer_noon, sweep.patch(0)), start);
  Scene end = start;
  end.sun.elevation_deg = 10;
  EXPECT_EQ(read_scene(summer_noon, sweep.patch(2)), end);
  const auto pitch = read_sweep(summer_noon, 3, {{"camera.pitch_deg", 20}}, "/to/", "");
  EXPECT_EQ(pitch.patch(2), (json{{"camera", {{"pitch_deg", 20}}}})) << "and no more";
}

TEST(Stream, APlaceIsSweptToo) {
  const auto sweep = read_sweep(summer_noon, 3, {{"sun.place.latitude_deg", 60.5}}, "/to/", "");
  json north = summer_noon;
  for (int i = 0; i < 3; ++i) {
    north["sun"]["place"]["latitude_deg"] = 48.5 + 6 * i;
    EXPECT_EQ(canonical(read_scene(summer_noon, sweep.patch(i))), canonical(read_scene(north)))
        << i;
  }
  EXPECT_THROW(read_sweep(summer_noon, 3, {{"sun.place.time", 1}}, "/to/", ""), SceneError);
}

TEST(Stream, HeadSaysTheTypeAlone) {
  const auto head = client().Head("/v1/stream?refine=true");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_THAT(head->get_header_value("Content-Type"),
              ::testing::StartsWith("multipart/x-mixed-replace"));
}

std::string stream_request(const std::string& query) {
  return "GET /v1/stream?" + query + " HTTP/1.1\r\nHost: h\r\n\r\n";
}

TEST(Stream, AReaderThatLeavesCancelsTheRest) {
  auto& queue = shared_daemon().service().queue;
  const auto before = queue.counts();
  RawClient raw;
  raw.send(
      stream_request("image.width=320&image.height=180&method.name=nishita"
                     "&method.view_samples=200&frames=1000&to.sun.elevation_deg=60"));
  std::string answer;
  while (answer.find("Cyanometer-Frame: 1/1000") == std::string::npos) {
    const auto more = raw.receive(10ms);
    answer += more;
  }
  raw.close();
  std::this_thread::sleep_for(1s);
  const auto then = queue.counts().done;
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(queue.counts().done, then);
  EXPECT_LT(then - before.done, 900u);
}

TEST(Stream, AReaderThatDoesNotReadHoldsUpItselfAlone) {
  auto& queue = shared_daemon().service().queue;
  // Kernels that are compiled first would look like a reader that is waited for.
  ASSERT_EQ(client().Get("/v1/render?" + large_link + "&sun.elevation_deg=61")->status, 200);
  const auto before = queue.counts().done;
  RawClient slow;
  slow.send(stream_request(large_link + "&frames=300&to.sun.elevation_deg=60"));
  wait_until_still(queue, before);
  EXPECT_LT(queue.counts().done - before, 100u);
  json fresh = tiny_scene();
  fresh["image"]["exposure_ev"] = 0.359;
  const auto answer = client().Post("/v1/render", fresh.dump(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->get_header_value("Cache-Status"), "cyanometer; fwd=miss");
  EXPECT_EQ(queue.depth(), 0u);
}

/// Frames of 12 MiB each, soon made, of which no buffers between here and there hold one.
const std::string huge_link =
    "image.width=1024&image.height=1024&image.format=npy&method.name=raymarch"
    "&method.scattering_orders=0&camera.altitude_km=1e5&camera.pitch_deg=90";

/// Waits until the device has had nothing to do for half a second.
void wait_until_idle(const RenderQueue& queue) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  for (int idle = 0; idle < 10; ++idle) {
    std::this_thread::sleep_for(50ms);
    if (queue.busy() || queue.depth() > 0) idle = 0;
    ASSERT_LT(std::chrono::steady_clock::now(), end);
  }
}

/// How many frames a daemon of so much memory for them renders for a reader that does not read,
/// once it has rendered so many.
std::uint64_t rendered_unread(double frame_memory_mb, std::uint64_t awaited) {
  Config config = free_port();
  config.frame_memory_mb = frame_memory_mb;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  RawClient slow(daemon.port());
  slow.send(stream_request(huge_link + "&frames=50&to.sun.elevation_deg=60"));
  auto& frames = daemon.service().frames;
  for (int i = 0; i < 6000 && frames.counts().rendered < awaited; ++i) {
    std::this_thread::sleep_for(10ms);
  }
  wait_until_idle(daemon.service().queue);
  return frames.counts().rendered;
}

TEST(Stream, WhileAFrameIsSentTwoMoreAreMade) { EXPECT_EQ(rendered_unread(2048, 3), 3u); }

TEST(Stream, OfLargeFramesNoneIsMadeAhead) { EXPECT_EQ(rendered_unread(64, 1), 1u); }

TEST(Stream, StoppingFinishesIt) {
  Daemon daemon(free_port());
  daemon.start();
  wait_until_ready(daemon);
  auto answer = std::async(std::launch::async, [&] {
    return client_of(daemon).Get("/v1/stream?" + tiny + "&frames=40&to.sun.elevation_deg=60");
  });
  std::this_thread::sleep_for(100ms);
  daemon.stop();
  const auto finished = answer.get();
  ASSERT_TRUE(finished);
  EXPECT_EQ(parts_of(finished->body).size(), 40u);
}

/// The sun goes to and fro where another method becomes the cheapest: along a stream the one
/// that does for both is kept. The device's speed is the nominal one, for which that place is
/// known.
TEST(Stream, AMethodIsKeptWhileItDoes) {
  const TemporaryFolder empty;
  const char* variable = "XDG_CACHE_HOME";
  const char* const before = std::getenv(variable);
  const std::string kept = before ? before : "";
  setenv(variable, empty.path().c_str(), 1);
  Daemon daemon(free_port());
  before ? setenv(variable, kept.c_str(), 1) : unsetenv(variable);
  wait_until_ready(daemon);
  auto& service = daemon.service();
  const auto changes = [&](auto plan_of) {
    std::string before;
    int found = 0;
    for (int i = 0; i < 8; ++i) {
      const json scene{{"image", {{"width", 16}, {"height", 12}}},
                       {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                       {"sun", {{"elevation_deg", i % 2 == 0 ? 60 : 8}}},
                       {"method", {{"max_error", 0.06}}}};
      const Scene read = read_scene(scene);
      const Plan plan = plan_of(SceneRequest{read, canonical(read).dump()});
      EXPECT_LE(plan.expected_error, 0.06) << i;
      std::string choice = plan.method;
      for (const auto& [name, value] : plan.options) choice += name + std::to_string(value);
      found += !before.empty() && choice != before;
      before = choice;
    }
    return found;
  };
  SteadyPlans steady(service, "test");
  EXPECT_EQ(changes([&](const SceneRequest& asked) {
              return plan_frame(asked, "test", service, {}).plan;
            }),
            7);
  EXPECT_EQ(changes([&](const SceneRequest& asked) { return steady.next(asked, {}).plan; }), 1);
}

}  // namespace
}  // namespace cyanometer::testing
