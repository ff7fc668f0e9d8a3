// Files as they should be are read as they were written; all others are refused by name.
#include "engine/image/exr_reader.h"

#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace cyanometer {
namespace {

using ::testing::HasSubstr;

constexpr int width = 24, height = 10;
constexpr std::size_t pixels = width * height;

class Memory : public Imf::OStream {
 public:
  explicit Memory(std::string& bytes) : OStream("memory"), bytes_(bytes) {}
  void write(const char c[], int n) override {
    bytes_.resize(std::max<std::size_t>(bytes_.size(), at_ + static_cast<std::size_t>(n)));
    std::memcpy(bytes_.data() + at_, c, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t at) override { at_ = at; }

 private:
  std::string& bytes_;
  uint64_t at_ = 0;
};

/// What a test file holds: channel k is k + pixel / 8, exact in a half.
struct File {
  std::vector<std::string> channels{"R", "G", "B"};
  Imf::PixelType type = Imf::FLOAT;
  int offset = 0;    ///< of the data window
  int sampling = 1;  ///< of the last channel
  bool tiled = false;
  unsigned tile = 16;
  float odd = 0;  ///< added to the middle pixel of the second channel
  std::function<void(Imf::Header&)> more = [](Imf::Header&) {};

  float value(std::size_t channel, std::size_t pixel) const {
    float v = static_cast<float>(channel) + static_cast<float>(pixel) / 8;
    return channel == 1 && pixel == pixels / 2 ? v + odd : v;
  }

  std::string bytes() const {
    Imath::Box2i window({offset, offset}, {offset + width - 1, offset + height - 1});
    Imf::Header header(window, window);
    std::vector<std::vector<float>> planes;
    Imf::FrameBuffer buffer;
    planes.reserve(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      int every = c + 1 == channels.size() ? sampling : 1;
      header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT, every, every));
      std::vector<float>& plane = planes.emplace_back(pixels);
      for (std::size_t i = 0; i < pixels; ++i) plane[i] = value(c, i);
      buffer.insert(channels[c],
                    Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float),
                                     width * sizeof(float), every, every));
    }
    if (type != Imf::FLOAT) {
      convert(header, buffer, planes);
    }
    more(header);
    std::string out;
    Memory stream(out);
    if (tiled) {
      header.setTileDescription(Imf::TileDescription(tile, tile));
      Imf::TiledOutputFile file(stream, header);
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(buffer);
      file.writePixels(height);
    }
    return out;
  }

  void convert(Imf::Header& header, Imf::FrameBuffer& buffer,
               std::vector<std::vector<float>>& planes) const {
    static std::vector<std::vector<half>> halves;
    static std::vector<std::uint32_t> whole(pixels, 1);
    halves.clear();
    halves.reserve(planes.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::vector<half>& plane = halves.emplace_back(planes[c].begin(), planes[c].end());
      bool integers = type == Imf::UINT;
      std::size_t size = integers ? 4 : 2;
      void* base = integers ? static_cast<void*>(whole.data()) : plane.data();
      header.channels().insert(channels[c], Imf::Channel(type));
      buffer.insert(channels[c],
                    Imf::Slice::Make(type, base, header.dataWindow(), size, width * size));
    }
  }
};

ExrImage read(const std::string& bytes, std::vector<std::string> channels = {"R", "G", "B"}) {
  return read_exr(bytes, channels, width, height);
}

std::string refusal(const std::string& bytes,
                    std::vector<std::string> channels = {"R", "G", "B"}) {
  try {
    read(bytes, std::move(channels));
  } catch (const ImageError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(ExrReader, ReadsTheWantedChannelsInTheirOrder) {
  for (const char* last : {"B", "Z"}) {
    File file;
    file.channels = {"R", "G", "B", "Z"};
    ExrImage image = read(file.bytes(), {"G", last});
    ASSERT_EQ(image.planes.size(), 2u);
    for (std::size_t i = 0; i < pixels; ++i) {
      EXPECT_EQ(image.planes[0][i], file.value(1, i));
      EXPECT_EQ(image.planes[1][i], file.value(*last == 'B' ? 2 : 3, i));
    }
  }
}

TEST(ExrReader, TakesHalfAndFloatRowsAndTilesWherever) {
  for (Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
    for (bool tiled : {false, true}) {
      for (int offset : {0, -7, 100}) {
        File file;
        file.type = type;
        file.tiled = tiled;
        file.offset = offset;
        ExrImage image = read(file.bytes());
        for (std::size_t i = 0; i < pixels; ++i) {
          ASSERT_EQ(image.planes[2][i], file.value(2, i)) << tiled << " " << offset;
        }
      }
    }
  }
}

TEST(ExrReader, SaysWhatTheFileSaysOfItsUnit) {
  EXPECT_FALSE(read(File().bytes()).white_luminance);
  EXPECT_TRUE(read(File().bytes()).rec709);
  File file;
  file.more = [](Imf::Header& header) {
    Imf::addWhiteLuminance(header, 250);
    Imf::addChromaticities(
        header, Imf::Chromaticities({0.7347f, 0.2653f}, {0.f, 1.f}, {0.0001f, -0.077f},
                                    {0.32168f, 0.33767f}));
  };
  EXPECT_EQ(read(file.bytes()).white_luminance, 250);
  EXPECT_FALSE(read(file.bytes()).rec709);
}

TEST(ExrReader, RefusesWhatIsNoExr) {
  EXPECT_THAT(refusal(""), HasSubstr("no OpenEXR"));
  EXPECT_THAT(refusal("{}"), HasSubstr("no OpenEXR"));
  EXPECT_THAT(refusal(std::string("\x89PNG\r\n\x1a\n")), HasSubstr("no OpenEXR"));
}

TEST(ExrReader, RefusesEveryFileThatIsCutOff) {
  for (bool tiled : {false, true}) {
    File file;
    file.tiled = tiled;
    const std::string whole = file.bytes();
    for (std::size_t length = 4; length < whole.size(); ++length) {
      EXPECT_NE(refusal(whole.substr(0, length)), "it was read") << length;
    }
    EXPECT_THAT(refusal(whole.substr(0, 100)), HasSubstr("ends early"));
    EXPECT_THAT(refusal(whole.substr(0, whole.size() - 9)), HasSubstr("EXR"));
  }
}

TEST(ExrReader, SurvivesEveryByteThatIsWrong) {
  for (bool tiled : {false, true}) {
    File file;
    file.tiled = tiled;
    const std::string whole = file.bytes();
    for (std::size_t i = 4; i < whole.size(); ++i) {
      for (char wrong : {'\x00', '\x7f', '\xff'}) {
        std::string bytes = whole;
        bytes[i] = wrong;
        try {
          read(bytes);
        } catch (const ImageError&) {
        }
      }
    }
  }
}

TEST(ExrReader, RefusesAnotherSizeAndSaysBoth) {
  const std::string bytes = File().bytes();
  try {
    read_exr(bytes, {"R"}, 32, 10);
    FAIL();
  } catch (const ImageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("24 x 10"));
    EXPECT_THAT(error.what(), HasSubstr("32 x 10"));
  }
}

TEST(ExrReader, RefusesAWindowOfBillionsBeforeItAllocates) {
  std::string bytes = File().bytes();
  const std::string name("dataWindow\0box2i\0", 17);
  std::size_t at = bytes.find(name) + name.size() + 4;
  const std::uint32_t far = 0x3fffffff;
  for (std::size_t corner : {8, 12}) std::memcpy(&bytes[at + corner], &far, 4);
  EXPECT_THAT(refusal(bytes), HasSubstr("1073741824 x 1073741824"));
}

TEST(ExrReader, RefusesChannelsThatAreNotThereOrNotThereForAll) {
  File grey;
  grey.channels = {"Y"};
  EXPECT_THAT(refusal(grey.bytes()), HasSubstr("no channel R; it has Y"));
  File integers;
  integers.type = Imf::UINT;
  EXPECT_THAT(refusal(integers.bytes()), HasSubstr("integers"));
  File sparse;
  sparse.sampling = 2;
  EXPECT_THAT(refusal(sparse.bytes()), HasSubstr("every pixel"));
  File many;
  for (int i = 0; i < 40; ++i) many.channels.push_back("extra" + std::to_string(i));
  EXPECT_THAT(refusal(many.bytes()), HasSubstr("43 channels"));
}

TEST(ExrReader, RefusesTilesOfUnusualSize) {
  File file;
  file.tiled = true;
  file.tile = 1;
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("tiles"));
}

TEST(ExrReader, RefusesValuesThatAreNoNumbersByTheirPlace) {
  File file;
  file.odd = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("channel G is not a number at column 0, row 5"));
  file.odd = std::numeric_limits<float>::infinity();
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("channel G is infinite"));
}

TEST(ExrReader, RefusesSeveralPartsAndDeepOnes) {
  for (bool deep : {false, true}) {
    Imf::Header header(width, height);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setType(deep ? Imf::DEEPSCANLINE : Imf::SCANLINEIMAGE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.setName("one");
    Imf::Header second = header;
    second.setName("two");
    std::string bytes;
    Memory stream(bytes);
    {
      const Imf::Header headers[]{header, second};
      Imf::MultiPartOutputFile file(stream, headers, deep ? 1 : 2);
    }
    EXPECT_THAT(refusal(bytes, {"R"}), HasSubstr(deep ? "deep" : "several parts"));
  }
}

}  // namespace
}  // namespace cyanometer
