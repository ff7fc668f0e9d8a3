#include "engine/accuracy/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/accuracy/error_picture.h"
#include "engine/accuracy/judgement.h"
#include "engine/image/encode.h"
#include "engine/optics/ciede2000.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Small, at three wavelengths, by a method that needs no plan.
Scene rgb_scene(const json& more = json::object()) {
  json document{{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                {"method", {{"name", "raymarch"}}},
                {"image", {{"width", 48}, {"height", 27}}}};
  document.merge_patch(more);
  return read_scene(document);
}

Comparison compared(const Scene& a, const Scene& b) {
  return compare(render_pair(device(), a, b));
}

TEST(Compare, OfASceneWithItselfIsZero) {
  for (const json& more :
       {json::object(), json{{"camera", {{"altitude_km", 10000}, {"pitch_deg", -60}}}},
        json{{"spectrum", {{"wavelengths_nm", {450, 500, 550, 600}}, {"colour", "cie"}}}}}) {
    Comparison same = compared(rgb_scene(more), rgb_scene(more));
    EXPECT_EQ(same.measure.error, 0);
    EXPECT_EQ(same.measure.bias, 0);
    EXPECT_EQ(same.measure.max, 0);
    EXPECT_EQ(same.ciede2000_p99, 0);
    EXPECT_EQ(same.banding, 0);
  }
}

TEST(Compare, TheOtherWayRoundHasTheOtherBias) {
  Scene bright = rgb_scene(), dark = rgb_scene({{"planet", {{"ground_albedo", 0.05}}}});
  Comparison there = compared(dark, bright), back = compared(bright, dark);
  EXPECT_LT(there.measure.bias, -0.01);
  EXPECT_NEAR(there.measure.bias, -back.measure.bias, 0.1 * back.measure.bias);
}

TEST(Compare, NeitherDiscNorStarsNorDisplayMatter) {
  Scene plain = rgb_scene({{"sun", {{"elevation_deg", 5}}}});
  Scene dressed = plain;
  plain.image.show.sun = plain.image.show.stars = false;
  dressed.image.tone_map = ToneMap::linear;
  dressed.image.exposure_ev = 4;
  dressed.image.show.clipped = true;
  EXPECT_EQ(compared(plain, dressed).measure.max, 0);
  EXPECT_EQ(compared(plain, dressed).ciede2000_p99, 0);
}

TEST(Compare, ASunTwiceAsBrightIsShownAsBrighter) {
  json strong{{"sun", {{"irradiance", 2}}}};
  Comparison compare = compared(rgb_scene(strong), rgb_scene());
  EXPECT_NEAR(compare.measure.bias, 0.5, 0.01);
  EXPECT_GT(compare.ciede2000_p99, 5);
}

TEST(Compare, FewSamplesAreWorseThanMany) {
  auto nishita = [&](int samples) {
    return rgb_scene({{"method", {{"name", "nishita"}, {"view_samples", samples}}}});
  };
  Comparison few = compared(nishita(4), rgb_scene()), many = compared(nishita(64), rgb_scene());
  EXPECT_GT(few.measure.error, many.measure.error);
  EXPECT_GT(few.ciede2000_p99, many.ciede2000_p99);
}

TEST(Compare, FramesThatDifferInShapeOrColourAreRefused) {
  auto pointer = [](const json& more) -> std::string {
    try {
      check_comparable(rgb_scene(), rgb_scene(more));
    } catch (const SceneError& error) {
      return error.pointer;
    }
    return "";
  };
  EXPECT_EQ(pointer({{"image", {{"width", 49}}}}), "/b/image/width");
  EXPECT_EQ(pointer({{"image", {{"height", 28}}}}), "/b/image/height");
  EXPECT_EQ(pointer({{"spectrum", {{"colour", "cie"}}}}), "/b/spectrum/colour");
  EXPECT_EQ(pointer({{"sun", {{"elevation_deg", 1}}}}), "");
}

// ---- the picture

double lightness(const std::array<unsigned char, 3>& c) {
  return lab_from_srgb({c[0] / 255.0, c[1] / 255.0, c[2] / 255.0})[0];
}

TEST(ErrorPicture, EndsAtTheNamedColoursAndIsNearWhiteBetween) {
  EXPECT_THAT(error_colour(-1), ::testing::ElementsAre(0x3b, 0x4c, 0xc0));
  EXPECT_THAT(error_colour(1), ::testing::ElementsAre(0xb4, 0x04, 0x26));
  for (double small : {0.0, 1e-5, -1e-5, 1e-4}) {
    EXPECT_THAT(error_colour(small), ::testing::Each(::testing::Ge(240))) << small;
  }
  EXPECT_EQ(error_colour(7), error_colour(1));
}

TEST(ErrorPicture, DarkensEvenlyByTheLogarithm) {
  for (double sign : {-1.0, 1.0}) {
    double before = lightness(error_colour(sign * 1e-4)), step = 0;
    for (double size : {1e-3, 1e-2, 1e-1, 1.0}) {
      double now = lightness(error_colour(sign * size));
      if (step > 0) {
        EXPECT_NEAR(before - now, step, 1);
      }
      step = before - now;
      EXPECT_GT(step, 5);
      before = now;
    }
  }
}

TEST(ErrorPicture, HoldsTheFrameAndItsScale) {
  std::string png = error_picture(std::vector<float>(8 * 4, 0.0f), 8, 4);
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  auto big_endian = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | (png[at + i] & 0xff);
    return value;
  };
  EXPECT_GE(big_endian(16), 8);
  EXPECT_GT(big_endian(20), 4);
}

TEST(ErrorPicture, OfEqualFramesIsWhite) {
  std::vector<float> map = error_map(render_pair(device(), rgb_scene(), rgb_scene()));
  for (float d : map) EXPECT_EQ(d, 0);
}

// ---- a picture against the converged solution

std::string exr_of(Scene scene, Plan& plan) {
  scene.image.format = ImageFormat::exr;
  Frame frame = device().render(scene);
  plan = frame.plan;
  return encode(frame, scene);
}

TEST(Judge, OurOwnFrameIsAsGoodAsItSays) {
  Scene asked = rgb_scene({{"method", {{"name", "auto"}}}});
  Plan plan;
  Comparison judged = judge(device(), asked, read_frame(exr_of(asked, plan), asked));
  ASSERT_TRUE(judged.error_95);
  double margin = (*judged.error_95)[1] - judged.measure.error;
  EXPECT_LT(judged.measure.error, plan.expected_error + margin);
  EXPECT_EQ(judged.banding, 0);
  EXPECT_LT(judged.ciede2000_p99, 2);
}

TEST(Judge, SingleScatteringLacksWhatItLacks) {
  Scene asked = rgb_scene();  // all orders, by a method that knows one
  Plan plan;
  JudgementGoal rough;
  rough.reference.noise = 0.02;
  Comparison judged = judge(device(), asked, read_frame(exr_of(asked, plan), asked), rough);
  EXPECT_GT(judged.measure.error, 0.05);
  EXPECT_LT(judged.measure.bias, -0.05);
}

TEST(Judge, TheDiscDoesNotCount) {
  Scene asked = rgb_scene({{"sun", {{"elevation_deg", 10}, {"angular_diameter_deg", 10}}},
                           {"method", {{"scattering_orders", 1}}}});
  Plan plan;
  ExrImage image = read_frame(exr_of(asked, plan), asked);
  EXPECT_LT(judge(device(), asked, image).measure.error, 0.002);
  std::vector<float> map = judged_map(device(), asked, image);
  std::ptrdiff_t disc = std::ranges::count_if(map, [](float d) { return std::isnan(d); });
  EXPECT_GT(disc, 5);
  for (float d : map) EXPECT_FALSE(std::abs(d) > 0.01);
}

TEST(Judge, AnotherUnitIsConverted) {
  Scene asked =
      rgb_scene({{"spectrum", {{"wavelengths_nm", {450, 500, 550, 600}}, {"colour", "cie"}}},
                 {"image", {{"format", "exr"}}}});
  Frame frame = device().render(asked);
  ExrImage usual = read_frame(encode(frame, asked), asked);
  frame.white_luminance /= 4;
  ExrImage quarter = read_frame(encode(frame, asked), asked);
  for (std::size_t i = 0; i < usual.planes[1].size(); ++i) {
    EXPECT_FLOAT_EQ(quarter.planes[1][i], usual.planes[1][i] / 4);
  }
}

}  // namespace
}  // namespace cyanometer
