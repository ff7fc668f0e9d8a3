// An image that was cut off is told from a whole one.
#include "server/load/whole_image.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/image/encode.h"

namespace cyanometer::testing {
namespace {

constexpr int width = 40, height = 70;  ///< several chunks of an EXR

/// A slope, encoded.
std::string image_of(ImageFormat format) {
  std::vector<float> slope(std::size_t{width} * height);
  std::vector<unsigned char> rgbx(4 * slope.size());
  for (std::size_t i = 0; i < slope.size(); ++i) {
    slope[i] = static_cast<float>(i) / static_cast<float>(slope.size());
    rgbx[4 * i] = static_cast<unsigned char>(255 * slope[i]);
  }
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.rgbx = rgbx.data();
  frame.planes = {{"R", slope.data()}, {"G", slope.data()}, {"B", slope.data()}};
  frame.description = "{}";
  Scene scene;
  scene.image.width = width;
  scene.image.height = height;
  scene.image.format = format;
  return encode(frame, scene);
}

TEST(WholeImage, IsToldFromEveryPartOfItself) {
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr}) {
    const std::string image = image_of(format);
    const auto type = encoding(format).media_type;
    EXPECT_TRUE(is_whole_image(image, type)) << type;
    for (std::size_t length = 0; length < image.size(); ++length) {
      EXPECT_FALSE(is_whole_image({image.data(), length}, type)) << type << ", " << length;
    }
  }
}

TEST(WholeImage, OfAnotherTypeIsNone) {
  EXPECT_FALSE(is_whole_image(image_of(ImageFormat::png), "image/jpeg"));
  EXPECT_FALSE(is_whole_image(image_of(ImageFormat::jpeg), "image/x-exr"));
  EXPECT_FALSE(is_whole_image(image_of(ImageFormat::exr), "image/png"));
}

TEST(WholeImage, OfTypesWithoutAnEndIsTheClientsToTell) {
  EXPECT_TRUE(is_whole_image("", "application/x-npy"));
}

TEST(WholeImage, OffsetsBeyondTheFileAreNoEnd) {
  std::string exr = image_of(ImageFormat::exr);
  for (std::size_t i = 8; i < exr.size(); ++i) {
    std::string damaged = exr;
    damaged[i] = '\xff';
    (void)is_whole_image(damaged, "image/x-exr");  // what it says is open; it must end
  }
}

}  // namespace
}  // namespace cyanometer::testing
