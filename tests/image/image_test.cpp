// Every format is read back by its own library where there is one, else by a reader written
// here.
#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>

#include "engine/attention.h"
#include "engine/image/encode.h"

namespace cyanometer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kDescription = R"({"scene":{"sun":{"elevation_deg":4}},"name":"Bläue"})";

struct Size {
  int width, height;
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};
constexpr Size kSizes[] = {{1, 1}, {3, 5}, {7, 2}, {8, 3}, {8191, 1}, {1, 4099}, {1031, 517}};

using Values = std::vector<float>;
using Bytes = std::vector<unsigned char>;

/// A frame and the pixels that it points to.
struct Picture {
  explicit Picture(Size size_, std::vector<std::string> channels = {"R", "G", "B"})
      : size(size_), values(channels.size(), Values(size.pixels())), rgbx(4 * size.pixels()) {
    frame.width = size.width;
    frame.height = size.height;
    frame.rgbx = rgbx.data();
    frame.description = kDescription;
    for (std::size_t c = 0; c < channels.size(); ++c)
      frame.planes.push_back({channels[c], values[c].data()});
  }
  Size size;
  std::vector<Values> values;
  Bytes rgbx;
  Frame frame;
};

Picture noise(Size size, float largest) {
  Picture picture(size);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(0.01f * largest, largest);
  for (Values& plane : picture.values)
    for (float& v : plane) v = value(random);
  for (unsigned char& v : picture.rgbx) v = static_cast<unsigned char>(random() & 0xff);
  return picture;
}

/// Like a sky: smooth, brightest in one corner.
Picture gradient(Size size) {
  Picture picture(size);
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const auto width = static_cast<std::size_t>(size.width);
    const float x = static_cast<float>(i % width) / static_cast<float>(size.width);
    const float y = static_cast<float>(i / width) / static_cast<float>(size.height);
    for (std::size_t c = 0; c < 3; ++c) {
      picture.values[c][i] = 0.2f + std::exp(-x - (1 + static_cast<float>(c)) * y);
      picture.rgbx[4 * i + c] = static_cast<unsigned char>(150 * picture.values[c][i]);
    }
  }
  return picture;
}

std::string encoded(const Picture& picture, ImageFormat format) {
  Scene scene;
  scene.image.format = format;
  return encode(picture.frame, scene);
}

/// Without the fourth byte of each pixel.
Bytes rgb_of(const Bytes& rgbx) {
  Bytes rgb;
  for (std::size_t i = 0; i < rgbx.size(); ++i)
    if (i % 4 != 3) rgb.push_back(rgbx[i]);
  return rgb;
}

// ---- The table of formats

TEST(Encodings, AreOneForEachFormatWithNamesOfTheirOwn) {
  ASSERT_EQ(encodings().size(), 5u);
  for (const Encoding& one : encodings()) {
    EXPECT_EQ(encoding(one.format).name, one.name);
    EXPECT_FALSE(one.extensions.empty());
    for (const Encoding& other : encodings()) {
      if (&one == &other) continue;
      EXPECT_NE(one.name, other.name);
      EXPECT_NE(one.media_type, other.media_type);
    }
  }
}

TEST(Encodings, AFrameWithoutThePixelsOfItsFormatIsRefusedNamingTheFormat) {
  for (const Encoding& one : encodings()) {
    Picture picture({2, 2});
    picture.frame.rgbx = nullptr;
    picture.frame.planes.clear();
    try {
      encoded(picture, one.format);
      ADD_FAILURE() << one.name;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(one.name) + ": "));
    }
  }
}

TEST(Encodings, TheSameFrameHasTheSameBytes) {
  const Picture picture = gradient({64, 48});
  for (const Encoding& one : encodings())
    EXPECT_EQ(encoded(picture, one.format), encoded(picture, one.format)) << one.name;
}

TEST(Encodings, StopWhereNobodyWaits) {
  const Picture picture = gradient({256, 1024});
  for (const ImageFormat format :
       {ImageFormat::png, ImageFormat::exr, ImageFormat::hdr, ImageFormat::npy}) {
    Watch watch;
    int looks = 0;
    watch.gone = [&] { return ++looks == 2; };
    const Attention attention(watch);
    EXPECT_THROW(encoded(picture, format), Cancelled);
    EXPECT_EQ(looks, 2);
  }
}

TEST(Encodings, ValuesThatAreNoNumbersDoNoHarm) {
  Picture picture({8, 1});
  const float inf = std::numeric_limits<float>::infinity();
  picture.values[0] = {NAN, inf, -inf, -0.0f, 1e-45f, 3e38f, -1, 0};
  for (const Encoding& one : encodings()) EXPECT_FALSE(encoded(picture, one.format).empty());
}

// ---- PNG

struct Png {
  Size size{};
  Bytes rgb;
  std::string key, text;
  int text_compression = 0, intent = -1, interlace = -1;
};

Png read_png(const std::string& file) {
  const auto fail = [](png_structp, png_const_charp why) { throw std::runtime_error(why); };
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, fail);
  png_infop info = png_create_info_struct(png);
  std::istringstream stream(file);
  png_set_read_fn(png, &stream, [](png_structp p, png_bytep to, size_t count) {
    auto& from = *static_cast<std::istringstream*>(png_get_io_ptr(p));
    if (!from.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count)))
      png_error(p, "the file ends too early");
  });
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  Png result;
  result.size = {static_cast<int>(png_get_image_width(png, info)),
                 static_cast<int>(png_get_image_height(png, info))};
  EXPECT_EQ(png_get_bit_depth(png, info), 8);
  EXPECT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
  png_get_sRGB(png, info, &result.intent);
  png_bytepp rows = png_get_rows(png, info);
  for (int y = 0; y < result.size.height; ++y)
    result.rgb.insert(result.rgb.end(), rows[y], rows[y] + 3 * result.size.width);
  png_textp texts = nullptr;
  if (png_get_text(png, info, &texts, nullptr) == 1) {
    result.key = texts[0].key;
    result.text = texts[0].text;
    result.text_compression = texts[0].compression;
  }
  EXPECT_EQ(stream.peek(), EOF) << "nothing follows the end";
  png_destroy_read_struct(&png, &info, nullptr);
  return result;
}

TEST(Png, KeepsEveryPixelAtEverySize) {
  for (const Size size : kSizes)
    for (const Picture& picture : {noise(size, 1), gradient(size)}) {
      const Png png = read_png(encoded(picture, ImageFormat::png));
      EXPECT_EQ(png.size.width, size.width);
      EXPECT_EQ(png.size.height, size.height);
      EXPECT_TRUE(png.rgb == rgb_of(picture.rgbx)) << size.width << " x " << size.height;
    }
}

TEST(Png, SaysThatItIsSrgbAndCarriesTheDescriptionAsPlainUtf8) {
  const Png png = read_png(encoded(gradient({9, 9}), ImageFormat::png));
  EXPECT_EQ(png.key, "cyanometer");
  EXPECT_EQ(png.text, kDescription);
  EXPECT_EQ(png.text_compression, PNG_ITXT_COMPRESSION_NONE);
  EXPECT_EQ(png.intent, PNG_sRGB_INTENT_PERCEPTUAL);
}

TEST(Png, OfASmoothPictureIsSmall) {
  const Picture picture = gradient({1920, 1080});
  EXPECT_LT(encoded(picture, ImageFormat::png).size(), picture.size.pixels() / 4);
}

// ---- JPEG

struct Jpeg {
  Size size{};
  int subsampling = -1;
  Bytes rgb;
};

Jpeg read_jpeg(const std::string& file) {
  tjhandle decoder = tjInitDecompress();
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  Jpeg result;
  int colours = 0;
  EXPECT_EQ(tjDecompressHeader3(decoder, bytes, file.size(), &result.size.width,
                                &result.size.height, &result.subsampling, &colours),
            0);
  result.rgb.resize(3 * result.size.pixels());
  EXPECT_EQ(
      tjDecompress2(decoder, bytes, file.size(), result.rgb.data(), result.size.width, 0,
                    result.size.height, TJPF_RGB, TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING),
      0)
      << tjGetErrorStr2(decoder);
  tjDestroy(decoder);
  return result;
}

std::string jpeg_comment(const std::string& file) {
  std::string text;
  for (std::size_t i = 2; i + 4 < file.size() && file[i] == '\xff' && file[i + 1] != '\xda';) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(file[at]); };
    const std::size_t length = byte(i + 2) * 256u + byte(i + 3);
    if (file[i + 1] == '\xfe') text += file.substr(i + 4, length - 2);
    i += 2 + length;
  }
  return text;
}

TEST(Jpeg, LooksTheSameAtEverySize) {
  for (const Size size : kSizes) {
    const Picture picture = gradient(size);
    const Jpeg jpeg = read_jpeg(encoded(picture, ImageFormat::jpeg));
    ASSERT_EQ(jpeg.size.width, size.width);
    ASSERT_EQ(jpeg.size.height, size.height);
    EXPECT_EQ(jpeg.subsampling, TJSAMP_444);
    const Bytes expected = rgb_of(picture.rgbx);
    double squares = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      squares += std::pow(double(expected[i]) - double(jpeg.rgb[i]), 2);
    const double steepness = 1.0 / size.width + 1.0 / size.height;
    EXPECT_LT(std::sqrt(squares / static_cast<double>(expected.size())), 1 + 6 * steepness)
        << size.width << " x " << size.height;
  }
}

TEST(Jpeg, CarriesADescriptionOfAnyLength) {
  Picture picture = gradient({16, 16});
  for (const std::size_t length : {0u, 100u, 65533u, 65534u, 200000u}) {
    picture.frame.description = std::string(length, 'x');
    if (length) picture.frame.description.back() = 'y';
    const std::string file = encoded(picture, ImageFormat::jpeg);
    EXPECT_EQ(jpeg_comment(file), picture.frame.description) << length;
    read_jpeg(file);
  }
}

// ---- EXR

class MemoryReader : public Imf::IStream {
 public:
  explicit MemoryReader(const std::string& bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (n > bytes_.size() - position_) throw std::runtime_error("the file ends too early");
    std::memcpy(to, bytes_.data() + position_, n);
    position_ += n;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
};

struct Exr {
  explicit Exr(std::string file)
      : bytes(std::move(file)), stream(bytes), input(stream), header(input.header()) {
    const Imath::Box2i window = header.dataWindow();
    size = {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
  }
  Values plane(const std::string& channel) {
    Values values(size.pixels());
    Imf::FrameBuffer pixels;
    pixels.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                      sizeof(float), sizeof(float) * size_t(size.width)));
    input.setFrameBuffer(pixels);
    input.readPixels(0, size.height - 1);
    return values;
  }
  Imf::PixelType type(const std::string& channel) const {
    return header.channels()[channel].type;
  }
  std::vector<std::string> channels() const {
    std::vector<std::string> names;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
      names.push_back(i.name());
    return names;
  }
  std::string bytes;
  MemoryReader stream;
  Imf::InputFile input;
  Imf::Header header;
  Size size{};
};

TEST(Exr, IsHalfWithinHalfAUnitOfItsLastPlaceWhereHalvesDo) {
  for (const Size size : kSizes) {
    const Picture picture = noise(size, 100);
    Exr exr(encoded(picture, ImageFormat::exr));
    ASSERT_EQ(exr.size.width, size.width);
    ASSERT_EQ(exr.size.height, size.height);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string channel = picture.frame.planes[c].channel;
      EXPECT_EQ(exr.type(channel), Imf::HALF);
      const Values read = exr.plane(channel);
      for (std::size_t i = 0; i < read.size(); ++i)
        ASSERT_LE(std::fabs(read[i] - picture.values[c][i]), std::ldexp(read[i], -11) * 1.001);
    }
  }
}

TEST(Exr, IsFloatOfAHalfsPrecisionInAllChannelsWhereAHalfWouldOverflowOrLoseItsLastNormalBit) {
  for (const float value : {65505.0f, -1e9f, 6e-5f, -1e-30f})
    for (const Size size : kSizes) {
      Picture picture = noise(size, 100);
      picture.values[1].back() = value;
      Exr exr(encoded(picture, ImageFormat::exr));
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string channel = picture.frame.planes[c].channel;
        EXPECT_EQ(exr.type(channel), Imf::FLOAT);
        const Values read = exr.plane(channel);
        for (std::size_t i = 0; i < read.size(); ++i) {
          const float error = std::fabs(read[i] - picture.values[c][i]);
          ASSERT_LE(error, std::ldexp(std::fabs(read[i]), -11) * 1.001) << value;
        }
      }
    }
}

TEST(Exr, KeepsTheLastValuesThatAreExactInHalf) {
  Picture picture({4, 1});
  picture.values[0] = {65504, -65504, 0x1p-14f, 0};
  Exr exr(encoded(picture, ImageFormat::exr));
  EXPECT_EQ(exr.type("R"), Imf::HALF);
  EXPECT_EQ(exr.plane("R"), picture.values[0]);
}

TEST(Exr, CarriesChannelsAndLayersAsTheyAreNamed) {
  Picture picture({5, 4}, {"550nm", "B", "G", "R", "transmittance.R"});
  for (std::size_t c = 0; c < 5; ++c)
    std::ranges::fill(picture.values[c], static_cast<float>(c + 1));
  Exr exr(encoded(picture, ImageFormat::exr));
  EXPECT_THAT(exr.channels(), ElementsAre("550nm", "B", "G", "R", "transmittance.R"));
  for (std::size_t c = 0; c < 5; ++c)
    EXPECT_EQ(exr.plane(picture.frame.planes[c].channel), picture.values[c]);
}

Exr exr_of(Frame frame, Scene scene) {
  scene.image.format = ImageFormat::exr;
  return Exr(encode(frame, scene));
}

TEST(Exr, CarriesTheStandardAttributesThatApply) {
  Picture picture = gradient({8, 4});
  picture.frame.white_luminance = 1000;
  const Exr cie = exr_of(picture.frame, {});
  EXPECT_EQ(Imf::whiteLuminance(cie.header), 1000);
  const Imf::Chromaticities& c = Imf::chromaticities(cie.header);
  EXPECT_EQ(c.red, Imath::V2f(0.64f, 0.33f));  // ITU-R BT.709-6, item 1.3 and 1.4
  EXPECT_EQ(c.green, Imath::V2f(0.30f, 0.60f));
  EXPECT_EQ(c.blue, Imath::V2f(0.15f, 0.06f));
  EXPECT_EQ(c.white, Imath::V2f(0.3127f, 0.3290f));
  EXPECT_EQ(cie.header.typedAttribute<Imf::StringAttribute>("cyanometer").value(),
            kDescription);
  EXPECT_FALSE(Imf::hasEnvmap(cie.header));

  picture.frame.white_luminance = 0;
  Scene spectral;
  spectral.image.channels = Channels::spectral;
  const Exr radiances = exr_of(picture.frame, spectral);
  EXPECT_FALSE(Imf::hasWhiteLuminance(radiances.header));
  EXPECT_FALSE(Imf::hasChromaticities(radiances.header));
}

TEST(Exr, APanoramaIsALatitudeLongitudeMap) {
  const Picture picture = gradient({64, 32});
  Scene scene;
  scene.camera.projection = Projection::equirectangular;
  const Exr exr = exr_of(picture.frame, scene);
  ASSERT_TRUE(Imf::hasEnvmap(exr.header));
  EXPECT_EQ(Imf::envmap(exr.header), Imf::ENVMAP_LATLONG);
  // OpenEXR's centre looks along +Z, up is +Y: what is to the right, as azimuth grows, is -X.
  const auto direction = [&](float x, float y) {
    return Imf::LatLongMap::direction(exr.header.dataWindow(), Imath::V2f(x, y));
  };
  EXPECT_LT((direction(31.5f, 15.5f) - Imath::V3f(0, 0, 1)).length(), 1e-5f);
  EXPECT_LT(direction(40, 15.5f).x, 0);
  EXPECT_GT(direction(31.5f, 4).y, 0);
}

TEST(Exr, ACubemapIsNoneOfItsOwnSinceItsFacesAreMirrored) {
  const Picture picture = gradient({16, 96});
  Scene scene;
  scene.camera.projection = Projection::cubemap;
  EXPECT_FALSE(Imf::hasEnvmap(exr_of(picture.frame, scene).header));
  // On -Z of an OpenGL cube map, s grows towards -X [OpenGL 4.6, table 8.19]; of OpenEXR's, to
  // +X.
  const Imath::Box2i window({0, 0}, {15, 95});
  EXPECT_GT(Imf::CubeMap::direction(Imf::CUBEFACE_NEG_Z, window, {15, 7}).x, 0);
}

// ---- HDR

struct Hdr {
  std::vector<std::string> header;
  Size size{};
  std::vector<std::array<unsigned char, 4>> pixels;
  std::array<double, 3> rgb(std::size_t i) const {
    const auto& p = pixels[i];
    const double unit = p[3] ? std::ldexp(1.0, p[3] - 136) : 0;
    return {p[0] * unit, p[1] * unit, p[2] * unit};
  }
  std::optional<std::string> field(const std::string& name) const {
    for (const std::string& line : header)
      if (line.starts_with(name)) return line.substr(name.size());
    return {};
  }
};

Hdr read_hdr(const std::string& file) {
  std::istringstream in(file);
  Hdr hdr;
  for (std::string line; std::getline(in, line) && !line.empty();) hdr.header.push_back(line);
  std::string y, x;
  in >> y >> hdr.size.height >> x >> hdr.size.width;
  EXPECT_EQ(y + x, "-Y+X");
  EXPECT_EQ(in.get(), '\n');
  const auto byte = [&] { return static_cast<unsigned char>(in.get()); };
  const auto width = static_cast<std::size_t>(hdr.size.width);
  for (int row = 0; row < hdr.size.height; ++row) {
    const std::size_t start = hdr.pixels.size();
    hdr.pixels.resize(start + width);
    if (width < 8 || width > 32767) {
      for (std::size_t i = start; i < start + width; ++i)
        for (unsigned char& v : hdr.pixels[i]) v = byte();
      continue;
    }
    EXPECT_EQ(byte(), 2);
    EXPECT_EQ(byte(), 2);
    const unsigned high = byte(), low = byte();
    EXPECT_EQ(high * 256 + low, width);
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < width;) {
        const unsigned code = byte();
        const std::size_t count = code > 128 ? code - 128 : code;
        if (count == 0 || count > width - i) throw std::runtime_error("a run beyond its row");
        unsigned char value = code > 128 ? byte() : 0;
        for (std::size_t end = i + count; i < end; ++i) {
          if (code <= 128) value = byte();
          hdr.pixels[start + i][c] = value;
        }
      }
  }
  EXPECT_TRUE(in.good());
  EXPECT_EQ(in.peek(), EOF) << "nothing follows the last row";
  return hdr;
}

TEST(Hdr, IsWithinHalfAUnitOfItsMantissaAtEverySize) {
  for (const Size size : kSizes)
    for (const Picture& picture : {noise(size, 1e6f), gradient(size)}) {
      const Hdr hdr = read_hdr(encoded(picture, ImageFormat::hdr));
      ASSERT_EQ(hdr.size.width, size.width);
      ASSERT_EQ(hdr.size.height, size.height);
      for (std::size_t i = 0; i < size.pixels(); ++i) {
        const double largest =
            std::max({picture.values[0][i], picture.values[1][i], picture.values[2][i]});
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_LE(std::fabs(hdr.rgb(i)[c] - picture.values[c][i]), largest / 255);
      }
    }
}

TEST(Hdr, HoldsWhatItsExponentReaches) {
  Picture picture({10, 1});
  picture.values[0] = {1, 255.9f, 0.99999f, 1e-30f, 0, -5, 1.7e38f, 1e-40f, 1e-37f, 0x1p-127f};
  const Hdr hdr = read_hdr(encoded(picture, ImageFormat::hdr));
  const double expected[] = {1, 256, 1, 1e-30, 0, 0, 1.7e38, 0, 1e-37, 0x1p-127};
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(hdr.rgb(i)[0], expected[i], expected[i] / 256) << i;
}

TEST(Hdr, KeepsTheLuminanceOfColoursThatItCannotHold) {
  Picture picture({8, 1});
  for (std::size_t i = 0; i < 8; ++i) {
    picture.values[0][i] = -0.3f;
    picture.values[1][i] = 1.0f;
    picture.values[2][i] = 0.5f;
  }
  const auto rgb = read_hdr(encoded(picture, ImageFormat::hdr)).rgb(3);
  const auto luminance = [](double r, double g, double b) {
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  EXPECT_NEAR(luminance(rgb[0], rgb[1], rgb[2]), luminance(-0.3, 1, 0.5), 0.005);
  EXPECT_EQ(rgb[0], 0);
}

TEST(Hdr, SaysWhatItsNumbersMean) {
  Picture picture = gradient({8, 4});
  picture.frame.white_luminance = 1000;
  const Hdr hdr = read_hdr(encoded(picture, ImageFormat::hdr));
  EXPECT_EQ(hdr.header.front(), "#?RADIANCE");
  EXPECT_EQ(hdr.field("FORMAT="), "32-bit_rle_rgbe");
  EXPECT_EQ(hdr.field("PRIMARIES="), "0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290");
  EXPECT_EQ(hdr.field("# cyanometer "), kDescription);
  // Radiance: luminance = 179 lm/W times the value over EXPOSURE. A value of 1 is 1000 cd/m^2.
  EXPECT_NEAR(179 / std::stod(hdr.field("EXPOSURE=").value()), 1000, 1e-3);
  picture.frame.white_luminance = 0;
  EXPECT_FALSE(read_hdr(encoded(picture, ImageFormat::hdr)).field("EXPOSURE="));
}

// ---- NPY

TEST(Npy, IsFloat32OfHeightWidthChannels) {
  for (const Size size : kSizes) {
    const Picture picture = noise(size, 1);
    const std::string file = encoded(picture, ImageFormat::npy);
    ASSERT_EQ(file.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const std::size_t length =
        static_cast<unsigned char>(file[8]) + 256u * static_cast<unsigned char>(file[9]);
    const std::string header = file.substr(10, length);
    EXPECT_EQ((10 + length) % 64, 0u);
    EXPECT_EQ(header.back(), '\n');
    EXPECT_THAT(header, HasSubstr("'descr': '<f4', 'fortran_order': False, 'shape': (" +
                                  std::to_string(size.height) + ", " +
                                  std::to_string(size.width) + ", 3)"));
    ASSERT_EQ(file.size(), 10 + length + size.pixels() * 12);
    Values values(size.pixels() * 3);
    std::memcpy(values.data(), file.data() + 10 + length, values.size() * sizeof(float));
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_EQ(values[i], picture.values[i % 3][i / 3]);
  }
}

}  // namespace
}  // namespace cyanometer
