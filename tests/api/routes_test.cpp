// Each route: what it answers, and how it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <set>
#include <sstream>
#include <thread>

#include "engine/engine.h"
#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/http/accept.h"
#include "server/routes/json_answer.h"
#include "server/routes/route.h"
#include "tests/api/client.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;

const std::string small_link = "/v1/render?image.width=16&image.height=8";

httplib::Result post(const std::string& path, const json& body,
                     const httplib::Headers& headers = {}) {
  return client().Post(path, headers, body.dump(), "application/json");
}

bool has(const httplib::Response& answer, const std::string& text) {
  return answer.body.find(text) != std::string::npos;
}

void expect_problem(const httplib::Result& answer, int status,
                    const std::string& pointer = "") {
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, status) << answer->body;
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/problem+json");
  const auto problem = json::parse(answer->body);
  EXPECT_EQ(problem.at("status"), status);
  EXPECT_FALSE(problem.at("title").get<std::string>().empty());
  EXPECT_FALSE(problem.at("detail").get<std::string>().empty());
  if (!pointer.empty()) {
    EXPECT_EQ(problem.at("pointer"), pointer);
  }
}

// ---- render

TEST(Render, ASceneBecomesAPngThatSaysHowItWasMade) {
  const auto answer = post("/v1/render", small_scene());
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(answer->get_header_value("Content-Type"), "image/png");
  EXPECT_TRUE(answer->body.starts_with("\x89PNG"));
  EXPECT_FALSE(answer->get_header_value("Cyanometer-Method").empty());
  EXPECT_THAT(answer->get_header_value("Cyanometer-Options"), ::testing::HasSubstr("="));
  EXPECT_GE(std::stod(answer->get_header_value("Cyanometer-Error")), 0);
  EXPECT_THAT(answer->get_header_value("Cyanometer-Met"), ::testing::AnyOf("true", "false"));
  EXPECT_NO_THROW((void)std::stod(answer->get_header_value("Cyanometer-Exposure")));
  EXPECT_EQ(answer->get_header_value("Cyanometer-Atmosphere"),
            atmosphere_key(read_scene(small_scene())));
  EXPECT_THAT(answer->get_header_value("ETag"), ::testing::MatchesRegex("\"[0-9a-f]{32}\""));
  EXPECT_THAT(answer->get_header_value("Server-Timing"),
              ::testing::MatchesRegex("queue;dur=[0-9.]+, prepare;dur=[0-9.]+, "
                                      "render;dur=[0-9.]+, encode;dur=[0-9.]+"));
}

TEST(Render, TheFormatOfTheSceneBeatsTheAcceptHeader) {
  auto scene = small_scene();
  scene["image"]["format"] = "npy";
  const auto answer = post("/v1/render", scene, {{"Accept", "image/png"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/x-npy");
  EXPECT_TRUE(answer->body.starts_with("\x93NUMPY"));
}

TEST(Render, TheAcceptHeaderChoosesTheFormat) {
  for (const auto& each : encodings()) {
    const std::string type(each.media_type);
    const auto answer = post("/v1/render", small_scene(), {{"Accept", type}});
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
    EXPECT_EQ(answer->get_header_value("Content-Type"), type);
  }
}

TEST(Render, WhatNobodyCanMakeIsNotAcceptable) {
  const auto answer =
      post("/v1/render", small_scene(), {{"Accept", "image/webp, image/png;q=0"}});
  expect_problem(answer, 406);
  EXPECT_THAT(json_of(answer).at("allowed"), ::testing::HasSubstr("image/png"));
}

TEST(Render, ABodyIsJsonWhateverItsTypeSays) {
  for (const auto* type : {"application/x-www-form-urlencoded", "text/plain", "image/png"}) {
    auto scene = small_scene();
    scene["method"] = {{"name", "auto"}};
    const auto answer =
        client().Post("/v1/render", scene.dump() + std::string(9000, ' '), type);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
  }
}

TEST(Render, ALinkMeansTheSameAsTheBody) {
  const auto link = client().Get(small_link + "&sun.elevation_deg=4&preset=earth");
  auto scene = small_scene();
  scene["sun"] = {{"elevation_deg", 4}};
  const auto body = post("/v1/render", scene);
  ASSERT_TRUE(link);
  ASSERT_TRUE(body);
  EXPECT_EQ(link->status, 200) << link->body;
  EXPECT_EQ(link->body, body->body);
  EXPECT_EQ(link->get_header_value("ETag"), body->get_header_value("ETag"));
}

TEST(Render, APathThatIsGivenTwiceIsRefused) {
  expect_problem(client().Get(small_link + "&sun.elevation_deg=4&sun.elevation_deg=4"), 400);
}

TEST(Render, AFreshLinkIsAnswered304WithoutRendering) {
  const auto first = client().Get(small_link);
  ASSERT_TRUE(first);
  const auto tag = first->get_header_value("ETag");
  for (const auto& asked : {tag, "W/" + tag, "\"other\", " + tag, std::string("*")}) {
    const auto again = get_if_changed(small_link, asked);
    EXPECT_EQ(status_of(again), 304) << asked;
    EXPECT_TRUE(again.ends_with("\r\n\r\n"));
    EXPECT_THAT(again, ::testing::HasSubstr("ETag: " + tag));
    EXPECT_EQ(count(again, "Server-Timing"), 0u);
    EXPECT_EQ(count(again, "Content-Length"), 0u);
  }
}

TEST(Render, AnotherSceneHasAnotherTag) {
  const auto first = client().Get(small_link);
  ASSERT_TRUE(first);
  const auto other = client().Get(small_link + "&sun.elevation_deg=4",
                                  {{"If-None-Match", first->get_header_value("ETag")}});
  ASSERT_TRUE(other);
  EXPECT_EQ(other->status, 200);
  EXPECT_NE(other->get_header_value("ETag"), first->get_header_value("ETag"));
}

TEST(Render, HeadSaysWhatGetWouldWithoutAFrame) {
  const auto head = client().Head(small_link);
  const auto get = client().Get(small_link);
  ASSERT_TRUE(head);
  ASSERT_TRUE(get);
  EXPECT_EQ(head->status, 200);
  for (const auto* name : {"ETag", "Content-Type", "Cyanometer-Method", "Cache-Control"}) {
    EXPECT_EQ(head->get_header_value(name), get->get_header_value(name)) << name;
  }
  EXPECT_TRUE(head->body.empty());
}

TEST(Render, ATimeBudgetIsNeverStored) {
  auto scene = small_scene();
  scene["method"] = {{"max_ms", 1000}};
  const auto answer = post("/v1/render", scene);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->get_header_value("Cache-Control"), "no-store");
}

TEST(Render, AnEmptyBodyIsRefused) {
  expect_problem(client().Post("/v1/render", "", "application/json"), 400);
}

TEST(Render, ABodyThatIsNotJsonIsRefused) {
  for (const auto* body : {"{", "nan", "{\"a\":1,\"a\":1}", "\xff", "{} {}", "[]", "3"}) {
    expect_problem(client().Post("/v1/render", body, "application/json"), 400);
  }
}

TEST(Render, ADeepBodyIsRefused) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  expect_problem(client().Post("/v1/render", deep, "application/json"), 400);
}

TEST(Render, ARefusedMemberIsNamed) {
  const auto answer = post("/v1/render", {{"planet", {{"radius_km", -1}}}});
  expect_problem(answer, 400, "/planet/radius_km");
  EXPECT_EQ(json_of(answer).at("given"), "-1");
  EXPECT_FALSE(json_of(answer).at("allowed").get<std::string>().empty());
}

TEST(Render, AFrameOverTheLimitsIsRefusedWithItsPointer) {
  expect_problem(post("/v1/render", {{"image", {{"width", 8192}, {"height", 4096}}}}), 422,
                 "/image/width");
}

TEST(Render, AFrameThatNeedsTooMuchMemoryIsRefused) {
  json scene{
      {"image",
       {{"width", 4096}, {"height", 4096}, {"format", "exr"}, {"channels", "spectral"}}}};
  for (int i = 0; i < 64; ++i) scene["spectrum"]["wavelengths_nm"].push_back(400 + i);
  scene["spectrum"]["colour"] = "cie";
  expect_problem(post("/v1/render", scene), 422, "/image");
}

TEST(Render, AFrameWhoseWavelengthsNeedTooMuchMemoryIsRefused) {
  Config config = free_port();
  config.frame_memory_mb = 1;
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  const auto status = [&](const char* path, const json& body, const std::string& pointer = "") {
    const auto answer = client_of(daemon).Post(path, body.dump(), "application/json");
    if (!pointer.empty()) expect_problem(answer, 422, pointer);
    return answer->status;
  };
  // The image and four layers have room at 4 wavelengths and not at 6; it is the plan that says
  // how many there are.
  json scene{{"method", {{"scattering_orders", 1}}},
             {"image",
              {{"width", 160},
               {"height", 80},
               {"format", "exr"},
               {"channels", "spectral"},
               {"layers", {"transmittance", "inscatter", "ground", "sun"}}}}};
  status("/v1/render", scene, "/image");
  status("/v1/plan", scene, "/image");
  status("/v1/stream", {{"scene", scene}, {"refine", true}}, "/scene/image");
  status("/v1/stream", {{"scene", scene}, {"frames", {json::object()}}}, "/frames/0/image");
  scene["method"]["max_error"] = 10;
  EXPECT_EQ(status("/v1/render", scene), 200);
}

TEST(Render, JsonThatIsTooLongIsSaidToBeSo) {
  const auto answer =
      client().Post("/v1/render", std::string(most_json_bytes, ' ') + "{}", "application/json");
  expect_problem(answer, 413);
  EXPECT_THAT(json_of(answer).at("allowed"),
              ::testing::HasSubstr(std::to_string(most_json_bytes)));
}

// ---- radiance and plan

TEST(Radiance, EachDirectionHasAValueForEachWavelength) {
  const json body{{"scene", {{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}}},
                  {"directions",
                   {{{"elevation_deg", 90}, {"azimuth_deg", 0}},
                    {{"elevation_deg", -90}, {"azimuth_deg", -360}}}},
                  {"irradiance", true}};
  const auto answer = json_of(post("/v1/radiance", body));
  EXPECT_EQ(answer.at("wavelengths_nm"), json({680, 550, 440}));
  ASSERT_EQ(answer.at("radiance").size(), 2u);
  ASSERT_EQ(answer.at("transmittance").size(), 2u);
  for (const auto& row : answer.at("radiance")) {
    ASSERT_EQ(row.size(), 3u);
    for (const auto& value : row) EXPECT_GT(value.get<double>(), 0);
  }
  EXPECT_TRUE(answer.contains("standard_error"));
  EXPECT_FALSE(answer.at("method").get<std::string>().empty());
  EXPECT_TRUE(answer.at("error").is_number());
  for (const auto* flux : {"direct", "diffuse_down", "diffuse_up"}) {
    EXPECT_EQ(answer.at("irradiance").at(flux).size(), 3u);
  }
}

TEST(Radiance, ColourAndLuminanceAreThoseOfThePicture) {
  json scene = small_scene();
  scene["camera"] = {{"fov_deg", 1}, {"pitch_deg", 40}, {"heading_deg", 120}};
  scene["method"] = {{"name", "raymarch"}};
  scene["spectrum"] = {{"wavelengths_nm", {420, 460, 500, 540, 580, 620, 660}},
                       {"colour", "cie"}};
  scene["image"] = {{"width", 1}, {"height", 1}, {"format", "npy"}};
  const auto image = post("/v1/render", scene);
  ASSERT_EQ(image->status, 200) << image->body;
  std::array<float, 3> pixel{};
  std::memcpy(pixel.data(), image->body.data() + image->body.size() - sizeof pixel,
              sizeof pixel);
  const auto answer = json_of(post(
      "/v1/radiance",
      {{"scene", scene}, {"directions", {{{"elevation_deg", 40}, {"azimuth_deg", 120}}}}}));
  const auto& rgb = answer.at("rgb").at(0);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(rgb.at(c).get<double>(), pixel[c], 1e-4 * pixel[c]);
  }
  // Rec. 709's luminance, in kcd/m^2.
  const double y = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
  EXPECT_NEAR(answer.at("luminance_cd_m2").at(0).get<double>(), 1000 * y, 0.5 * y);
}

TEST(Radiance, ChannelsHaveNoLuminance) {
  const auto answer = json_of(
      post("/v1/radiance", {{"scene", {{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}}},
                            {"directions", {{{"elevation_deg", 90}, {"azimuth_deg", 0}}}}}));
  EXPECT_TRUE(answer.at("luminance_cd_m2").is_null());
  EXPECT_EQ(answer.at("rgb").at(0).size(), 3u);
}

TEST(Radiance, TheBodyIsReadStrictly) {
  const json up{{"elevation_deg", 90}, {"azimuth_deg", 0}};
  const auto with = [](const char* name, const json& value) {
    json direction{{"elevation_deg", 1}, {"azimuth_deg", 1}};
    direction[name] = value;
    return json{{"directions", {direction}}};
  };
  const std::vector<std::pair<json, std::string>> cases{
      {json::object(), "/directions"},
      {{{"directions", json::array()}}, "/directions"},
      {{{"directions", 3}}, "/directions"},
      {with("elevation_deg", 90.5), "/directions/0/elevation_deg"},
      {with("azimuth_deg", -361), "/directions/0/azimuth_deg"},
      {with("azimuth_deg", "1"), "/directions/0/azimuth_deg"},
      {with("roll/deg", 1), "/directions/0/roll~1deg"},
      {{{"directions", {up, 3}}}, "/directions/1"},
      {{{"directions", {{{"azimuth_deg", 1}}}}}, "/directions/0/elevation_deg"},
      {{{"directions", {up}}, {"irradiance", 1}}, "/irradiance"},
      {{{"directions", {up}}, {"more", 1}}, "/more"},
      {{{"directions", {up}}, {"scene", {{"sun", {{"elevation_deg", 100}}}}}},
       "/scene/sun/elevation_deg"},
  };
  for (const auto& [body, pointer] : cases) {
    SCOPED_TRACE(body.dump());
    const auto answer = post("/v1/radiance", body);
    expect_problem(answer, 400, pointer);
    EXPECT_THAT(json_of(answer).at("detail"), ::testing::HasSubstr(pointer));
  }
}

TEST(Radiance, MoreThan4096DirectionsAreOverTheLimit) {
  json body{{"directions", json::array()}};
  for (int i = 0; i < 4097; ++i) {
    body["directions"].push_back({{"elevation_deg", 45}, {"azimuth_deg", 0}});
  }
  expect_problem(post("/v1/radiance", body), 422, "/directions");
  body["directions"].erase(0);
  const auto most = post("/v1/radiance", body);
  ASSERT_TRUE(most);
  EXPECT_EQ(most->status, 200) << most->body.substr(0, 300);
}

TEST(Plan, SaysWhatWouldBeDone) {
  const auto answer = json_of(post("/v1/plan", small_scene()));
  EXPECT_EQ(answer.at("scene").at("image").at("width"), 16);
  EXPECT_EQ(read_scene(answer.at("scene")), read_scene(small_scene()));
  EXPECT_FALSE(answer.at("method").get<std::string>().empty());
  EXPECT_TRUE(answer.at("options").is_object());
  EXPECT_GE(answer.at("wavelengths_nm").size(), 1u);
  EXPECT_GE(answer.at("error").get<double>(), 0);
  EXPECT_GE(answer.at("ms").get<double>(), 0);
  EXPECT_TRUE(answer.at("met").is_boolean());
  EXPECT_FALSE(answer.at("why").get<std::string>().empty());
  EXPECT_EQ(answer.at("atmosphere"), atmosphere_key(read_scene(small_scene())));
}

TEST(Plan, ALinkMeansTheSameAsTheBody) {
  EXPECT_EQ(json_of(client().Get("/v1/plan?image.width=16&image.height=8")),
            json_of(post("/v1/plan", small_scene())));
}

TEST(Plan, IsTheSameAsThatOfTheFrame) {
  const auto plan = json_of(post("/v1/plan", small_scene()));
  const auto frame = post("/v1/render", small_scene());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->get_header_value("Cyanometer-Method"), plan.at("method"));
}

// ---- compare and explain

/// Quick to compare: three wavelengths, single scattering, no plan.
json quick_scene(double albedo = 0.1) {
  json scene = small_scene();
  scene["spectrum"] = {{"wavelengths_nm", {680, 550, 440}}};
  scene["method"] = {{"name", "raymarch"}, {"scattering_orders", 1}};
  scene["planet"] = {{"ground_albedo", albedo}};
  return scene;
}

const std::string quick_link =
    "/v1/compare?image.width=16&image.height=8&spectrum.wavelengths_nm=[680,550,440]"
    "&method.scattering_orders=1";

std::string exr_of(json scene) {
  scene["image"]["format"] = "exr";
  const auto answer = post("/v1/render", scene);
  return answer && answer->status == 200 ? answer->body : "";
}

httplib::Result judge(const std::string& link, const std::string& exr,
                      const httplib::Headers& headers = {}) {
  return client().Post(link, headers, exr, "image/x-exr");
}

TEST(Compare, TwoScenesGiveTheFiguresOfTheContract) {
  const auto answer = post("/v1/compare", {{"a", quick_scene(0.2)}, {"b", quick_scene()}});
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/json");
  const auto figures = json::parse(answer->body);
  EXPECT_EQ(figures.size(), 6u);
  for (const auto* name : {"error", "bias", "p99", "max", "ciede2000_p99", "banding"}) {
    EXPECT_TRUE(figures.at(name).is_number()) << name;
  }
  EXPECT_GT(figures.at("bias"), 0);
}

TEST(Compare, TheAcceptHeaderAsksForAPicture) {
  const json body{{"a", quick_scene()}, {"b", quick_scene()}};
  const auto picture = post("/v1/compare", body, {{"Accept", "image/png"}});
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->status, 200) << picture->body;
  EXPECT_EQ(picture->get_header_value("Content-Type"), "image/png");
  EXPECT_TRUE(picture->body.starts_with("\x89PNG"));
  const auto any = post("/v1/compare", body, {{"Accept", "*/*"}});
  ASSERT_TRUE(any);
  EXPECT_EQ(any->get_header_value("Content-Type"), "application/json");
  const auto neither = post("/v1/compare", body, {{"Accept", "image/jpeg"}});
  expect_problem(neither, 406);
  EXPECT_THAT(json_of(neither).at("allowed"), ::testing::HasSubstr("image/png"));
}

TEST(Compare, TheBodyIsReadStrictly) {
  auto wide = quick_scene(), coloured = quick_scene(), large = quick_scene();
  wide["image"]["width"] = 17;
  coloured["spectrum"]["colour"] = "cie";
  large["image"] = {{"width", 8192}, {"height", 4096}};
  const std::vector<std::tuple<json, int, std::string>> cases{
      {json::object(), 400, "/a"},
      {{{"a", quick_scene()}}, 400, "/b"},
      {{{"a", quick_scene()}, {"b", 3}}, 400, "/b"},
      {{{"a", quick_scene()}, {"b", quick_scene()}, {"c", 1}}, 400, "/c"},
      {{{"a", {{"planet", {{"radius_km", -1}}}}}, {"b", json::object()}},
       400,
       "/a/planet/radius_km"},
      {{{"a", json::object()}, {"b", {{"sun", {{"elevation_deg", 100}}}}}},
       400,
       "/b/sun/elevation_deg"},
      {{{"a", quick_scene()}, {"b", wide}}, 400, "/b/image/width"},
      {{{"a", quick_scene()}, {"b", coloured}}, 400, "/b/spectrum/colour"},
      {{{"a", large}, {"b", large}}, 422, "/a/image/width"},
  };
  for (const auto& [body, status, pointer] : cases) {
    SCOPED_TRACE(body.dump());
    expect_problem(post("/v1/compare", body), status, pointer);
  }
}

TEST(Compare, WhatOnlyWorkFindsIsSaidOfItsScene) {
  json high = quick_scene();
  high["planet"]["surface"] = {{"type", "procedural"}, {"relief_km", 100}};
  const std::string relief = "/planet/surface/relief_km";
  expect_problem(post("/v1/compare", {{"a", quick_scene()}, {"b", high}}), 400, "/b" + relief);
  expect_problem(post("/v1/compare", {{"a", high}, {"b", quick_scene()}}), 400, "/a" + relief);
  expect_problem(post("/v1/compare", {{"a", high}, {"b", high}}), 400, "/b" + relief);
}

TEST(Compare, AnExrIsJudgedAgainstTheSceneOfTheLink) {
  const std::string exr = exr_of(quick_scene());
  const auto answer = judge(quick_link, exr);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const auto figures = json::parse(answer->body);
  EXPECT_LT(figures.at("error"), 0.005);
  EXPECT_EQ(figures.at("error_95").size(), 2u);
  const auto picture = judge(quick_link, exr, {{"Accept", "image/png"}});
  ASSERT_TRUE(picture);
  EXPECT_TRUE(picture->body.starts_with("\x89PNG")) << picture->body;
}

TEST(Compare, AnExrThatCannotBeJudgedIsRefusedWithItsReason) {
  const std::string exr = exr_of(quick_scene());
  const auto refusal = [](const httplib::Result& answer) -> std::string {
    expect_problem(answer, 400);
    return json_of(answer).at("detail");
  };
  EXPECT_THAT(refusal(judge(quick_link, "{}")), ::testing::HasSubstr("no OpenEXR"));
  EXPECT_THAT(refusal(judge(quick_link, exr.substr(0, exr.size() / 2))),
              ::testing::HasSubstr("EXR"));
  EXPECT_THAT(refusal(judge(quick_link + "&planet.radius_km=-1", exr)),
              ::testing::HasSubstr("/planet/radius_km"));
  EXPECT_THAT(refusal(judge("/v1/compare?image.width=20&image.height=8", exr)),
              ::testing::HasSubstr("20 x 8"));
  expect_problem(judge(quick_link, exr, {{"Accept", "image/jpeg"}}), 406);
}

TEST(Explain, EveryIngredientHasItsWorth) {
  const auto answer = post("/v1/explain", quick_scene());
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const auto worths = json::parse(answer->body);
  for (const auto* name : {"air", "aerosol", "ozone", "curvature", "ground"}) {
    const auto& worth = worths.at(name);
    EXPECT_GE(worth.at("error").get<double>(), 0) << name;
    EXPECT_TRUE(worth.at("ciede2000").is_number()) << name;
    EXPECT_TRUE(worth.at("ms_saved").is_number()) << name;
  }
  EXPECT_EQ(worths.size(), 5u);
}

TEST(Explain, LinesTellHowFarItIsUntilTheIngredientsCome) {
  const auto answer = post("/v1/explain", quick_scene(), {{"Accept", "application/x-ndjson"}});
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(answer->get_header_value("X-Accel-Buffering"), "no");
  std::istringstream lines(answer->body);
  std::vector<json> told;
  for (std::string line; std::getline(lines, line);) told.push_back(json::parse(line));
  ASSERT_GE(told.size(), 2u) << answer->body;
  double before = 0;
  for (const json& line : told) {
    EXPECT_GE(line.at("progress").get<double>(), before);
    before = line["progress"];
    EXPECT_EQ(line.contains("ingredients"), &line == &told.back());
  }
  EXPECT_GT(told.front().at("progress"), 0);
  const auto whole = post("/v1/explain", quick_scene());
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->has_header("X-Accel-Buffering"));
  EXPECT_EQ(told.back().at("ingredients"), json::parse(whole->body));
}

TEST(Explain, RefusesAsOtherRoutesDo) {
  const httplib::Headers lines{{"Accept", "application/x-ndjson"}};
  expect_problem(post("/v1/explain", {{"planet", {{"radius_km", -1}}}}, lines), 400,
                 "/planet/radius_km");
  expect_problem(post("/v1/explain", {{"planet", {{"radius_km", -1}}}}), 400,
                 "/planet/radius_km");
  expect_problem(client().Post("/v1/explain", "", "application/json"), 400);
  expect_problem(post("/v1/explain", quick_scene(), {{"Accept", "image/png"}}), 406);
}

// ---- attribute

TEST(Attribute, SaysOfTheSceneSMethodWhereItsErrorComesFrom) {
  json scene = quick_scene();
  scene["method"] = {{"name", "nishita"}, {"view_samples", 8}, {"scattering_orders", 1}};
  const auto answer = post("/v1/attribute", scene);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const json found = json::parse(answer->body);
  EXPECT_EQ(found.at("method"), "nishita");
  EXPECT_EQ(found.at("options").at("view_samples"), 8);
  const json& share = found.at("shares").at(0);
  EXPECT_EQ(share.at("cause"), "quadrature");
  EXPECT_NEAR(share.at("error"), found.at("error"), 0.3 * found["error"].get<double>());
  EXPECT_THAT(share.at("how").get<std::string>(), ::testing::HasSubstr("view_samples 8 to 32"));
  const auto lines = post("/v1/attribute", scene, {{"Accept", "application/x-ndjson"}});
  ASSERT_TRUE(lines);
  EXPECT_EQ(lines->get_header_value("X-Accel-Buffering"), "no");
  const std::string last =
      lines->body.substr(lines->body.rfind('\n', lines->body.size() - 2) + 1);
  EXPECT_EQ(json::parse(last).at("attribution"), found);
}

// ---- what the page draws

TEST(Optics, ConstituentsComeAsCurves) {
  const auto answer = json_of(post("/v1/optics", {{"preset", "earth"}}));
  const auto altitudes = answer.at("altitude_km").size();
  const auto wavelengths = answer.at("wavelengths_nm").size();
  for (const auto* name : {"air", "aerosol", "ozone"}) {
    const auto& each = answer.at("constituents").at(name);
    EXPECT_EQ(each.at("density").size(), altitudes);
    EXPECT_EQ(each.at("scattering_per_km").size(), wavelengths);
    EXPECT_EQ(each.at("absorption_per_km").size(), wavelengths);
    EXPECT_EQ(each.at("optical_depth").size(), wavelengths);
  }
  const auto& phase = answer.at("constituents").at("aerosol").at("phase");
  ASSERT_EQ(phase.size(), answer.at("phase_wavelengths_nm").size());
  EXPECT_EQ(phase[0].size(), answer.at("angle_deg").size());
  EXPECT_TRUE(answer.at("constituents").at("ozone").at("phase").is_null());
}

TEST(Optics, RefusesAsOtherRoutesDo) {
  expect_problem(post("/v1/optics", {{"planet", {{"radius_km", -1}}}}), 400,
                 "/planet/radius_km");
  expect_problem(client().Post("/v1/optics", "", "application/json"), 400);
}

TEST(Day, HasItsTimesAndMoments) {
  const auto day = json_of(post("/v1/day", {{"latitude_deg", 48.85},
                                            {"longitude_deg", 2.35},
                                            {"date", "2026-06-21"},
                                            {"utc_offset_min", 120}}));
  EXPECT_LT(day.at("dawn"), day.at("sunrise"));
  EXPECT_LT(day.at("sunset"), day.at("dusk"));
  EXPECT_EQ(day.at("moments").size(), 145u);
  EXPECT_NEAR(day.at("highest").at("elevation_deg").get<double>(), 90 - 48.85 + 23.44, 0.1);
  const auto night = json_of(
      post("/v1/day", {{"latitude_deg", 80}, {"longitude_deg", 0}, {"date", "2026-12-21"}}));
  EXPECT_TRUE(night.at("sunrise").is_null());
}

TEST(Day, LongitudesAreThoseOfTheSunsPlace) {
  const auto highest = [](double longitude) {
    return json_of(post("/v1/day", {{"latitude_deg", 10},
                                    {"longitude_deg", longitude},
                                    {"date", "2026-06-21"}}))
        .at("highest");
  };
  const json east = highest(190), west = highest(-170);
  EXPECT_EQ(east.at("time"), west.at("time"));
  EXPECT_NEAR(east.at("elevation_deg").get<double>(), west.at("elevation_deg").get<double>(),
              1e-6);
}

TEST(Day, TheBodyIsReadStrictly) {
  const json sound{{"latitude_deg", 10}, {"longitude_deg", 20}, {"date", "2026-06-21"}};
  const std::vector<std::pair<json, std::string>> cases{
      {{{"latitude_deg", 91}}, "/latitude_deg"},
      {{{"latitude_deg", nullptr}}, "/latitude_deg"},
      {{{"longitude_deg", "20"}}, "/longitude_deg"},
      {{{"longitude_deg", 361}}, "/longitude_deg"},
      {{{"date", "2026-13-01"}}, "/date"},
      {{{"date", 20260621}}, "/date"},
      {{{"utc_offset_min", 1.5}}, "/utc_offset_min"},
      {{{"utc_offset_min", 900}}, "/utc_offset_min"},
      {{{"more", 1}}, "/more"}};
  for (const auto& [change, pointer] : cases) {
    json body = sound;
    body.update(change);
    SCOPED_TRACE(body.dump());
    expect_problem(post("/v1/day", body), 400, pointer);
  }
  expect_problem(post("/v1/day", {{"longitude_deg", 1}, {"date", "2026-01-01"}}), 400,
                 "/latitude_deg");
}

/// One order of scattering has no noise: its reference takes no walks.
const json single_order{{"method", {{"scattering_orders", 1}}}};

TEST(Chart, PointsComeLineByLineUntilTheReaderLeaves) {
  std::string text, buffering;
  std::size_t lines = 0;
  const auto answer = [&] {
    auto to = client();
    httplib::Request request;
    request.method = "POST";
    request.path = "/v1/chart";
    request.body = single_order.dump();
    request.response_handler = [&](const httplib::Response& head) {
      buffering = head.get_header_value("X-Accel-Buffering");
      return true;
    };
    request.content_receiver = [&](const char* data, std::size_t length, auto, auto) {
      text.append(data, length);
      lines = count(text, "\n");
      return lines < 4;
    };
    return to.send(request);
  }();
  ASSERT_GE(lines, 4u) << text;
  EXPECT_EQ(buffering, "no");
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  const auto head = json::parse(line);
  EXPECT_GT(head.at("points"), 10);
  EXPECT_EQ(head.at("width"), 320);
  std::set<std::string> methods_seen;
  for (int i = 0; i < 3; ++i) {
    std::getline(stream, line);
    const auto point = json::parse(line);
    methods_seen.insert(point.at("method"));
    EXPECT_GE(point.at("error").get<double>(), 0);
    EXPECT_GT(point.at("frame_ms").get<double>(), 0);
    EXPECT_FALSE(point.at("options").empty());
  }
  EXPECT_EQ(methods_seen.size(), 3u) << "each method has its turn";
  // Nobody reads on: the device is soon free.
  const auto frame = post("/v1/render", small_scene());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->status, 200);
}

TEST(Chart, RefusesAsOtherRoutesDo) {
  expect_problem(post("/v1/chart", {{"planet", {{"radius_km", -1}}}}), 400,
                 "/planet/radius_km");
  expect_problem(post("/v1/chart", {{"image", {{"width", 8192}, {"height", 8192}}}}), 422);
}

// ---- lists, documents, operations

TEST(Lists, MethodsComeWithTheirOptions) {
  const auto list = json_of(client().Get("/v1/methods")).at("methods");
  ASSERT_EQ(list.size(), methods().size());
  for (const auto& method : list) {
    for (const auto& option : method.at("options")) {
      EXPECT_LE(option.at("minimum").get<double>(), option.at("default").get<double>());
      EXPECT_GE(option.at("maximum").get<double>(), option.at("default").get<double>());
    }
  }
}

TEST(Lists, PresetsCiteTheirSourcesAndAreDocuments) {
  const auto list = json_of(client().Get("/v1/presets")).at("presets");
  ASSERT_EQ(list.size(), presets().size());
  for (const auto& preset : list) {
    EXPECT_FALSE(preset.at("title").get<std::string>().empty());
    EXPECT_FALSE(preset.at("source").get<std::string>().empty());
    EXPECT_TRUE(preset.at("scene").is_object());
  }
}

TEST(Lists, TheLimitsAreThoseOfTheContract) {
  const auto limits = json_of(client().Get("/v1/limits"));
  EXPECT_GE(limits.at("pixels"), 4096 * 4096);
  EXPECT_EQ(limits.at("wavelengths"), 64);
  EXPECT_EQ(limits.at("directions"), 4096);
  EXPECT_EQ(limits.at("deadline_s"), 600);
  EXPECT_EQ(limits.at("queue"), 64);
  EXPECT_EQ(limits.at("kernels"), 192);
  EXPECT_GT(limits.at("body_bytes"), 0);
  EXPECT_EQ(limits.at("json_bytes"), most_json_bytes);
  EXPECT_GT(limits.at("frame_bytes"), 0);
}

TEST(Lists, TheSchemaIsThatOfTheDocument) {
  EXPECT_EQ(json_of(client().Get("/v1/schema")), scene_schema());
}

TEST(OpenApi, ListsEveryRouteOfTheTableAndNothingElse) {
  const auto document = json_of(client().Get("/openapi.json"));
  EXPECT_EQ(document.at("openapi"), "3.1.0");
  std::set<std::string> listed, there;
  for (const auto& [path, operations] : document.at("paths").items()) {
    for (const auto& [method, operation] : operations.items()) {
      listed.insert(method + path);
      EXPECT_TRUE(operation.at("responses").contains("200"));
      EXPECT_FALSE(operation.at("summary").get<std::string>().empty());
    }
  }
  for (const auto& route : routes())
    there.insert((route.method == "GET" ? "get" : "post") + route.path);
  EXPECT_EQ(listed, there);
}

TEST(OpenApi, ABoundIsMeantToHoldAndNotPromised) {
  const auto document = json_of(client().Get("/openapi.json"));
  const json& headers =
      document.at("/paths/~1v1~1render/post/responses/200/headers"_json_pointer);
  EXPECT_THAT(headers.at("Cyanometer-Error").at("description").get<std::string>(),
              ::testing::HasSubstr("meant to hold"));
}

TEST(OpenApi, EveryReferenceLeadsSomewhere) {
  const auto document = json_of(client().Get("/openapi.json"));
  const auto text = document.at("paths").dump();
  for (auto at = text.find("#/components"); at != std::string::npos;
       at = text.find("#/components", at + 1)) {
    const auto pointer = text.substr(at + 1, text.find('"', at) - at - 1);
    EXPECT_TRUE(document.contains(json::json_pointer(pointer))) << pointer;
  }
}

TEST(Operations, HealthReadinessAndMetricsAreAnswered) {
  EXPECT_EQ(client().Get("/healthz")->status, 200);
  EXPECT_EQ(client().Get("/readyz")->status, 200);
  post("/v1/render", small_scene());
  // Work whose client has left, in a test before, may hold the device for a moment yet.
  auto metrics = client().Get("/metrics");
  for (int looks = 0; looks < 100 && metrics && !has(*metrics, "cyanometer_device_busy 0");
       ++looks) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    metrics = client().Get("/metrics");
  }
  ASSERT_TRUE(metrics);
  for (const auto* name :
       {"cyanometer_http_requests_total{route=\"/v1/render\",method=\"POST\",status=\"200\"}",
        "cyanometer_http_request_duration_seconds_bucket", "cyanometer_queue_depth 0",
        "cyanometer_device_busy 0", "cyanometer_jobs_total", "cyanometer_rejected_total",
        "cyanometer_cancelled_total", "cyanometer_build_info{version=",
        "cyanometer_stage_duration_seconds_sum{stage=\"encode\"}", "cyanometer_ready 1"}) {
    EXPECT_TRUE(has(*metrics, name)) << name;
  }
}

TEST(Operations, MetricsTellTheUseOfThisProcess) {
  const auto used_s = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double before_s = used_s();
  const auto metrics = client().Get("/metrics");
  ASSERT_TRUE(metrics);
  const auto value = [&](const std::string& name) {
    const auto at = metrics->body.find("\n" + name + " ");
    return at == std::string::npos ? 0 : std::stod(metrics->body.substr(at + name.size() + 2));
  };
  EXPECT_GE(value("process_cpu_seconds_total"), before_s);
  EXPECT_LE(value("process_cpu_seconds_total"), used_s());
  EXPECT_GT(value("process_resident_memory_bytes"), 1 << 20);
}

TEST(Operations, AListenerOfTheirOwnAnswersThemAlone) {
  Config config = free_port();
  config.ops_listen = "127.0.0.1:0";
  Daemon daemon(config);
  daemon.start();
  wait_until_ready(daemon);
  httplib::Client ops("127.0.0.1", daemon.ops_port());
  EXPECT_EQ(ops.Get("/healthz")->status, 200);
  EXPECT_EQ(ops.Get("/readyz")->status, 200);
  EXPECT_EQ(ops.Get("/metrics")->status, 200);
  EXPECT_EQ(ops.Get("/v1/limits")->status, 404);
}

TEST(Page, IsServedFromTheBinaryUnderAStrictPolicy) {
  const auto page = client().Get("/");
  ASSERT_TRUE(page);
  ASSERT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_THAT(page->get_header_value("Content-Security-Policy"),
              ::testing::HasSubstr("default-src 'none'; script-src 'self'"));
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(client().Get("/index.html")->body, page->body);
  EXPECT_EQ(status_of(get_if_changed("/", page->get_header_value("ETag"))), 304);
}

TEST(Page, APictureOfItHasItsStyleAlsoByItself) {
  const auto picture = client().Get("/failures.svg");
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->status, 200);
  EXPECT_TRUE(has(*picture, "<style>"));
  const auto policy = picture->get_header_value("Content-Security-Policy");
  EXPECT_THAT(policy, ::testing::HasSubstr("default-src 'none'; style-src 'unsafe-inline'"));
  EXPECT_THAT(policy, ::testing::Not(::testing::HasSubstr("script-src")));
}

TEST(Page, NothingOutsideItIsServed) {
  for (const auto* path : {"/../CMakeLists.txt", "/%2e%2e/etc/passwd", "//etc/passwd"}) {
    expect_problem(client().Get(path), 404);
  }
}

// ---- methods and addresses

TEST(Addresses, UnknownOnesAreNotFound) {
  expect_problem(client().Get("/v1/nothing"), 404);
  expect_problem(client().Post("/nothing", "{}", "application/json"), 404);
}

TEST(Addresses, AWrongMethodIsToldTheRightOnes) {
  const auto wrong = client().Get("/v1/radiance");
  expect_problem(wrong, 405);
  EXPECT_EQ(wrong->get_header_value("Allow"), "POST, OPTIONS");
  expect_problem(client().Delete("/v1/render"), 405);
  EXPECT_EQ(client().Delete("/v1/render")->get_header_value("Allow"),
            "GET, HEAD, POST, OPTIONS");
}

TEST(Addresses, AnUnknownMethodIsNotAllowed) {
  const auto answer =
      exchange("BREW /v1/render HTTP/1.1\r\nHost: h\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(status_of(answer), 405);
}

TEST(Addresses, OptionsSayWhatIsAllowed) {
  const auto answer = client().Options("/v1/limits");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 204);
  EXPECT_EQ(answer->get_header_value("Allow"), "GET, HEAD, OPTIONS");
}

TEST(Addresses, HeadHasTheLengthOfGet) {
  const auto head = client().Head("/v1/limits");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Length"),
            std::to_string(client().Get("/v1/limits")->body.size()));
}

TEST(Errors, NameTheRequest) {
  const auto answer = client().Get("/v1/nothing", {{"X-Request-Id", "abc"}});
  EXPECT_EQ(json_of(answer).at("instance"), "urn:cyanometer:request:abc");
}

// ---- parts

TEST(Accept, TheClosestRangeDecides) {
  const std::vector<std::string_view> types{"image/png", "image/x-exr", "image/jpeg"};
  EXPECT_EQ(preferred("*/*", types), 0u);
  EXPECT_EQ(preferred("image/*;q=0.5, image/jpeg", types), 2u);
  EXPECT_EQ(preferred("image/*, image/png;q=0", types), 1u);
  EXPECT_EQ(preferred("*/*;q=0.1, image/x-exr;q=0.2", types), 1u);
  EXPECT_EQ(preferred("IMAGE/JPEG ; q=0.3", types), 2u);
  EXPECT_EQ(preferred("text/html", types), std::nullopt);
  EXPECT_EQ(preferred("image/png;q=0", types), std::nullopt);
}

TEST(EntityTag, PartsDoNotRunTogether) {
  EXPECT_NE(entity_tag({"ab", "c"}), entity_tag({"a", "bc"}));
  EXPECT_EQ(entity_tag({"ab", "c"}), entity_tag({"ab", "c"}));
}

TEST(EntityTag, IsFnv1aWith128Bits) {
  // The published value of the empty text is the offset basis.
  EXPECT_EQ(entity_tag({}), "\"6c62272e07bb014262b821756295c58d\"");
}

}  // namespace
}  // namespace cyanometer::testing
