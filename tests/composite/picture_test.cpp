// Pictures of clients in the frame's unit.
#include "engine/image/picture.h"

#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/composite/picture_file.h"

namespace cyanometer {
namespace {

using ::testing::HasSubstr;

Scene scene_of_two_pixels() {
  Scene scene;
  scene.image.width = 2;
  scene.image.height = 1;
  return scene;
}

std::string picture_in(float white_luminance, float colour) {
  const std::vector<float> plane(2, colour);
  return testing::picture_file(
      2, 1, {{"R", plane}, {"G", plane}, {"B", {1, colour}}, {"Z", {1, 1}}},
      [&](Imf::Header& header) { Imf::addWhiteLuminance(header, white_luminance); });
}

std::string refusal_of_picture(const std::string& bytes, double scale = 1) {
  try {
    read_picture(bytes, scene_of_two_pixels(), scale);
  } catch (const ImageError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(Pictures, AreScaledByWhatTheySayOfTheirUnit) {
  EXPECT_EQ(read_picture(picture_in(250, 2), scene_of_two_pixels(), 4).rgb[0].at(0), 2);
  EXPECT_EQ(read_frame(picture_in(250, 2), scene_of_two_pixels()).planes[2].at(1), 0.5f);
  EXPECT_EQ(read_picture(picture_in(0, 2), scene_of_two_pixels()).rgb[0].at(0), 2) << "unknown";
}

TEST(Pictures, OfAUnitThatIsNotFiniteAreRefused) {
  const float infinite = std::numeric_limits<float>::infinity();
  for (const float unit : {std::nanf(""), infinite, -infinite}) {
    EXPECT_THAT(refusal_of_picture(picture_in(unit, 1)), HasSubstr("whiteLuminance")) << unit;
    EXPECT_THROW(read_frame(picture_in(unit, 1), scene_of_two_pixels()), ImageError) << unit;
  }
}

TEST(Pictures, ThatAreNotFiniteOnceTheyAreScaledAreRefusedByTheirPlace) {
  EXPECT_EQ(refusal_of_picture(picture_in(1000, 1e30f)), "it was read");
  EXPECT_THAT(refusal_of_picture(picture_in(1000, 1e30f), 1e12),
              HasSubstr("channel R at column 0, row 0"));
  EXPECT_THAT(refusal_of_picture(picture_in(3e38f, -1e30f)), HasSubstr("channel R"));
  EXPECT_EQ(refusal_of_picture(picture_in(3e38f, 1e3f)), "it was read");
}

}  // namespace
}  // namespace cyanometer
