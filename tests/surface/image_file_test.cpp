// What stands in files of heights and colours, whatever they say of themselves.
#include "engine/surface/image_file.h"

#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <png.h>
#include <turbojpeg.h>

#include <functional>

#include "tests/composite/picture_file.h"

namespace cyanometer {
namespace {

using cyanometer::testing::picture_file;
using ::testing::HasSubstr;

/// A row of a PNG, two pixels wide.
struct PngRow {
  int bits, colour_type;
  std::vector<unsigned char> bytes;
  std::function<void(png_structp, png_infop)> say = [](png_structp, png_infop) {};

  std::string file() const {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::string file;
    png_set_write_fn(
        png, &file,
        [](png_structp p, png_bytep from, std::size_t count) {
          static_cast<std::string*>(png_get_io_ptr(p))
              ->append(reinterpret_cast<const char*>(from), count);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, 2, 1, bits, colour_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    say(png, info);
    png_write_info(png, info);
    png_write_row(png, bytes.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
  }
};

std::vector<float> heights_of(const std::string& file, const std::string& extension = "png") {
  return read_heights(file, extension).planes.at(0);
}

std::string refusal_of_heights(const std::string& file, const std::string& extension) {
  try {
    read_heights(file, extension);
  } catch (const ImageError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(HeightFiles, OfAPngStandAsInTheFileWhateverItSaysOfGamma) {
  const std::vector<std::function<void(png_structp, png_infop)>> sayings{
      [](png_structp, png_infop) {},
      [](png_structp png, png_infop info) { png_set_gAMA_fixed(png, info, 100000); },
      [](png_structp png, png_infop info) { png_set_gAMA_fixed(png, info, 45455); },
      [](png_structp png, png_infop info) {
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
      },
      [](png_structp png, png_infop info) {
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
      }};
  for (std::size_t i = 0; i < sayings.size(); ++i) {
    SCOPED_TRACE(i);
    const PngRow eight{8, PNG_COLOR_TYPE_GRAY, {64, 128}, sayings[i]};
    EXPECT_EQ(heights_of(eight.file()), (std::vector{64 / 255.f, 128 / 255.f}));
    const PngRow sixteen{16, PNG_COLOR_TYPE_GRAY, {0x40, 0x01, 0x80, 0x02}, sayings[i]};
    EXPECT_EQ(heights_of(sixteen.file()), (std::vector{0x4001 / 65535.f, 0x8002 / 65535.f}));
  }
}

TEST(HeightFiles, OfColoursAreTheirMean) {
  const PngRow eight{8, PNG_COLOR_TYPE_RGB, {255, 0, 0, 10, 20, 30}};
  EXPECT_EQ(heights_of(eight.file()), (std::vector{1 / 3.f, 20 / 255.f}));
  const PngRow sixteen{16, PNG_COLOR_TYPE_RGB, {255, 255, 0, 0, 0, 0, 1, 0, 2, 0, 3, 0}};
  EXPECT_EQ(heights_of(sixteen.file()), (std::vector{1 / 3.f, 512 / 65535.f}));
  const PngRow transparent{8, PNG_COLOR_TYPE_RGB_ALPHA, {255, 0, 0, 0, 10, 20, 30, 128}};
  EXPECT_EQ(heights_of(transparent.file()), (std::vector{1 / 3.f, 20 / 255.f}));
  const PngRow palette{8, PNG_COLOR_TYPE_PALETTE, {1, 0}, [](png_structp png, png_infop info) {
                         const png_color colours[]{{10, 20, 30}, {0, 0, 255}};
                         const png_byte opacities[]{0, 7};
                         png_set_PLTE(png, info, colours, 2);
                         png_set_tRNS(png, info, opacities, 2, nullptr);
                       }};
  EXPECT_EQ(heights_of(palette.file()), (std::vector{1 / 3.f, 20 / 255.f}));
  const PngRow bits{1, PNG_COLOR_TYPE_GRAY, {0x40}};
  EXPECT_EQ(heights_of(bits.file()), (std::vector{0.f, 1.f}));
}

std::string jpeg_of(const std::array<unsigned char, 3>& colour) {
  constexpr int width = 32, height = 16;
  std::vector<unsigned char> samples;
  for (int i = 0; i < width * height; ++i) {
    samples.insert(samples.end(), colour.begin(), colour.end());
  }
  tjhandle encoder = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(encoder, samples.data(), width, 0, height, TJPF_RGB, &bytes, &size,
                        TJSAMP_444, 100, 0),
            0);
  std::string file(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(encoder);
  return file;
}

TEST(HeightFiles, OfAJpegAreTheMeanOfItsColoursWithoutGamma) {
  EXPECT_NEAR(heights_of(jpeg_of({255, 0, 0}), "jpg").at(5), 1 / 3.0, 1.0 / 255);
  EXPECT_NEAR(heights_of(jpeg_of({0, 0, 255}), "jpg").at(5), 1 / 3.0, 1.0 / 255);
  EXPECT_NEAR(heights_of(jpeg_of({64, 64, 64}), "jpg").at(5), 64 / 255.0, 1.0 / 255);
}

TEST(HeightFiles, OfADamagedPngAreRefused) {
  const std::string whole =
      PngRow{16, PNG_COLOR_TYPE_GRAY, {1, 2, 3, 4}, [](auto...) {}}.file();
  EXPECT_THAT(refusal_of_heights("not an image", "png"), HasSubstr("PNG cannot be read: "));
  // All but the end, which holds no pixel: 12 bytes, and 4 of the checksum before.
  for (std::size_t length = 0; length < whole.size() - 16; ++length) {
    EXPECT_THAT(refusal_of_heights(whole.substr(0, length), "png"),
                HasSubstr("PNG cannot be read: "))
        << length;
  }
}

TEST(HeightFiles, OfAnExrAreItsYOrElseItsR) {
  const std::vector<float> low(2, 0.25f), high(2, 0.5f), beyond(2, 2.0f);
  EXPECT_EQ(heights_of(picture_file(2, 1, {{"Y", low}, {"R", high}}), "exr"), low);
  EXPECT_EQ(heights_of(picture_file(2, 1, {{"R", high}}), "exr"), high);
  EXPECT_THAT(refusal_of_heights(picture_file(2, 1, {{"Y", beyond}}), "exr"),
              HasSubstr("from 0 to 1"));
  EXPECT_THAT(refusal_of_heights(picture_file(2, 1, {{"Y", beyond}, {"R", high}}), "exr"),
              HasSubstr("from 0 to 1"));
  EXPECT_THAT(refusal_of_heights(picture_file(2, 1, {{"Z", low}}), "exr"),
              HasSubstr("no channel R; it has Z"));
}

TEST(ColourFiles, OfAnExrOfOtherPrimariesAreRefusedAndItsHeightsAreNot) {
  const std::vector<float> plane(2, 0.25f);
  const auto file = [&](const Imf::Chromaticities& chromaticities) {
    return picture_file(
        2, 1, {{"R", plane}, {"G", plane}, {"B", plane}},
        [&](Imf::Header& header) { Imf::addChromaticities(header, chromaticities); });
  };
  EXPECT_EQ(read_colours(file({}), "exr").planes[1], plane);
  const std::string aces =
      file({{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}});
  EXPECT_EQ(heights_of(aces, "exr"), plane);
  try {
    read_colours(aces, "exr");
    FAIL();
  } catch (const ImageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("Rec. 709"));
  }
}

}  // namespace
}  // namespace cyanometer
