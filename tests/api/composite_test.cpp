// POST /v1/composite: what it answers, and how it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/image/exr_reader.h"
#include "tests/api/client.h"
#include "tests/composite/picture_file.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr int width = 16, height = 8;
constexpr std::size_t pixels = width * height;
const std::string link =
    "/v1/composite?image.format=exr&spectrum.wavelengths_nm=[680,550,440]"
    "&method.name=raymarch&method.scattering_orders=1&image.show=[\"ground\"]";

httplib::Result post_picture(const std::string& target, const std::string& body,
                             const httplib::Headers& headers = {}) {
  return client().Post(target.c_str(), headers, body, "image/x-exr");
}

std::string card(float colour = 0.5f, float distance_km = 2) {
  return even_picture(width, height, colour, distance_km);
}

ExrImage answered(const httplib::Result& answer) {
  EXPECT_TRUE(answer);
  EXPECT_EQ(answer->status, 200) << answer->body.substr(0, 500);
  return read_exr(answer->body, {"R", "G", "B"}, width, height);
}

void expect_refused(const httplib::Result& answer, const std::string& detail,
                    const std::string& pointer = "", int status = 400) {
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, status) << answer->body.substr(0, 500);
  ASSERT_EQ(answer->get_header_value("Content-Type"), "application/problem+json");
  const auto problem = json::parse(answer->body);
  EXPECT_THAT(problem.at("detail").get<std::string>(), HasSubstr(detail));
  if (!pointer.empty()) {
    EXPECT_EQ(problem.at("pointer"), pointer);
  }
}

TEST(CompositeRoute, LaysTheAirOverThePictureAndSaysHow) {
  const auto answer = post_picture(link, card());
  const ExrImage image = answered(answer);
  for (float blue : image.planes[2]) {
    EXPECT_GT(blue, 0.2);
    EXPECT_LT(blue, 0.8);
  }
  for (const char* name :
       {"Cyanometer-Method", "Cyanometer-Options", "Cyanometer-Error", "Cyanometer-Met",
        "Cyanometer-Exposure", "Cyanometer-Atmosphere", "ETag", "Server-Timing"}) {
    EXPECT_TRUE(answer->has_header(name)) << name;
  }
  EXPECT_EQ(answer->get_header_value("Content-Type"), "image/x-exr");
}

TEST(CompositeRoute, AtDistanceZeroAnswersThePictureInItsUnit) {
  const ExrImage same = answered(post_picture(link, card(0.5f, 0)));
  for (float red : same.planes[0]) EXPECT_NEAR(red, 0.5, 1e-3);
  const ExrImage scaled = answered(post_picture(link + "&scale=3e2", card(0.5f, 0)));
  for (float red : scaled.planes[0]) EXPECT_NEAR(red, 150, 0.2);
}

/// A picture that was planned for is known the next time.
TEST(CompositeRoute, TimeSpentOnPlanningIsToldAsPreparation) {
  const auto prepare_ms = [](float distance_km) {
    const auto answer = post_picture(link, card(0.5f, distance_km));
    EXPECT_TRUE(answer);
    const std::string timing = answer->get_header_value("Server-Timing");
    const std::string name = "prepare;dur=";
    const auto at = timing.find(name);
    EXPECT_NE(at, std::string::npos) << timing;
    return at == std::string::npos ? 0 : std::stod(timing.substr(at + name.size()));
  };
  prepare_ms(7.5f);  // compiles
  const double planned = prepare_ms(8.25f);
  double known = planned;
  for (int i = 0; i < 3; ++i) known = std::min(known, prepare_ms(8.25f));
  EXPECT_GT(planned, 2 * known);
}

TEST(CompositeRoute, TheTagIsOfThePictureToo) {
  const auto tag = [](const httplib::Result& answer) {
    EXPECT_TRUE(answer);
    return answer->get_header_value("ETag");
  };
  const std::string one = tag(post_picture(link, card()));
  EXPECT_EQ(tag(post_picture(link, card())), one);
  EXPECT_NE(tag(post_picture(link, card(0.6f))), one);
  EXPECT_NE(tag(post_picture(link + "&scale=2", card())), one);
}

TEST(CompositeRoute, AnswersInEveryFormat) {
  const std::string any =
      "/v1/composite?spectrum.wavelengths_nm=[680,550,440]&method.name=raymarch";
  const auto png = post_picture(any, card());
  ASSERT_TRUE(png);
  EXPECT_TRUE(png->body.starts_with("\x89PNG")) << png->body;
  const auto jpeg = post_picture(any, card(), {{"Accept", "image/jpeg"}});
  ASSERT_TRUE(jpeg);
  EXPECT_EQ(jpeg->get_header_value("Content-Type"), "image/jpeg");
  for (const char* format : {"hdr", "npy"}) {
    const auto answer = post_picture(any + "&image.format=" + format, card());
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
  }
}

TEST(CompositeRoute, TheSizeIsThePictures) {
  EXPECT_EQ(post_picture(link + "&image.width=16", card())->status, 200);
  expect_refused(post_picture(link + "&image.width=17", card()), "16", "/image/width");
  expect_refused(post_picture(link + "&image.height=7", card()), "8", "/image/height");
  expect_refused(
      post_picture(link + "&camera.projection=equirectangular", even_picture(16, 16, 0.5f, 1)),
      "/image");
}

TEST(CompositeRoute, AFrameOverALimitIsRefusedBeforeItIsRead) {
  // Headers alone that say so many pixels: more than this server makes, than any scene has.
  for (const auto& [pixels, status] : {std::pair{16384, 422}, std::pair{40000, 400}}) {
    std::string bomb = even_picture(1, 1, 0, 0);
    const auto at = bomb.find("dataWindow");
    ASSERT_NE(at, std::string::npos);
    const std::int32_t last = pixels - 1;
    const auto value = at + sizeof "dataWindow" + sizeof "box2i" + 4 + 8;
    for (std::size_t i : {0, 4}) std::memcpy(&bomb[value + i], &last, 4);
    expect_refused(post_picture(link, bomb), std::to_string(pixels), "/image/width", status);
  }
}

TEST(CompositeRoute, PicturesThatAreNoneAreRefusedByName) {
  const std::vector<float> plane(pixels, 0.5f);
  const auto with = [&](const char* channel, float odd) {
    Channels channels{{"R", plane}, {"G", plane}, {"B", plane}, {"Z", plane}};
    channels.at(channel)[pixels / 2] = odd;
    return picture_file(width, height, channels);
  };
  const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
  expect_refused(post_picture(link, ""), "empty");
  expect_refused(post_picture(link, "{}"), "no OpenEXR");
  expect_refused(post_picture(link, card().substr(0, 300)), "EXR");
  expect_refused(post_picture(link, card().substr(0, card().size() - 40)), "EXR");
  expect_refused(post_picture(link, picture_file(width, height,
                                                 {{"R", plane}, {"G", plane}, {"B", plane}})),
                 "no channel Z");
  expect_refused(post_picture(link, picture_file(width, height,
                                                 {{"R", plane}, {"B", plane}, {"Z", plane}})),
                 "no channel G");
  expect_refused(post_picture(link, with("G", nan)),
                 "channel G is not a number at column 0, row 4");
  expect_refused(post_picture(link, with("B", infinite)), "channel B is infinite");
  expect_refused(post_picture(link, with("Z", nan)), "channel Z is not a number");
  expect_refused(post_picture(link, with("Z", -1)), "channel Z is negative at column 0, row 4");
  expect_refused(post_picture(link, with("Z", -infinite)), "channel Z is negative");
  EXPECT_EQ(post_picture(link, with("Z", infinite))->status, 200);
}

TEST(CompositeRoute, WhatIsAskedOfItIsChecked) {
  for (const char* scale : {"0", "-1", "abc", "1e13", "", "nan"}) {
    expect_refused(post_picture(link + "&scale=" + scale, card()), "/scale", "/scale");
  }
  expect_refused(post_picture(link + "&scale=1&scale=2", card()), "once", "/scale");
  expect_refused(post_picture(link + "&planet.radius_km=-1", card()), "/planet/radius_km");
  expect_refused(post_picture(link + "&image.channels=spectral", card()), "spectra",
                 "/image/channels");
  expect_refused(post_picture(link + "&image=5", card()), "/image");
  ASSERT_TRUE(post_picture(link, card(), {{"Accept", "text/html"}}));
  EXPECT_EQ(client().Get("/v1/composite")->status, 405);
}

}  // namespace
}  // namespace cyanometer::testing
