#include "engine/image/exr_reader.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>

#include "engine/attention.h"
#include "engine/engine.h"
#include "engine/image/formats.h"

namespace cyanometer {
namespace {

constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
constexpr std::size_t preamble = 8;  ///< magic number and version
constexpr std::uint32_t deep_flag = 0x800, multipart_flag = 0x1000;

// What the library allocates grows with these.
constexpr int most_channels = 32;
constexpr std::uint32_t smallest_tile = 8, largest_tile = 2048;

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : IStream("the EXR"), bytes_(bytes) {}
  bool read(char c[], int n) override {
    const auto wanted = static_cast<std::uint64_t>(n);
    if (n < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_) {
      throw Iex::InputExc("the file ends early");
    }
    std::memcpy(c, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::uint64_t position_ = 0;
};

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

[[noreturn]] void ends_early() { throw ImageError("The EXR ends early: it is cut off."); }

/// Walks over the header: each attribute says its size, which the library would believe and
/// allocate. [OpenEXR file layout: name, type, both ended by a zero; size; value]
void check_attributes(std::string_view bytes) {
  std::size_t at = preamble;
  auto skip_text = [&] {
    at = bytes.find('\0', at);
    if (at++ == std::string_view::npos) ends_early();
  };
  while (at < bytes.size() && bytes[at] != '\0') {
    skip_text();
    skip_text();
    if (bytes.size() - at < 4) ends_early();
    const std::uint32_t size = little_endian(bytes, at);
    at += 4;
    if (size > bytes.size() - at) ends_early();
    at += size;
  }
  if (at >= bytes.size()) ends_early();
}

void check_kind(std::string_view bytes) {
  if (!is_exr(bytes)) throw ImageError("This is no OpenEXR file.");
  if (bytes.size() < preamble) ends_early();
  const std::uint32_t version = little_endian(bytes, magic.size());
  if (version & multipart_flag) {
    throw ImageError("The EXR has several parts; one with a single part is taken.");
  }
  if (version & deep_flag) throw ImageError("The EXR is deep; a flat one is taken.");
}

Imf::Header read_header(std::string_view bytes) {
  MemoryInput stream(bytes);
  stream.seekg(preamble);
  int version = static_cast<int>(little_endian(bytes, magic.size()));
  Imf::Header header;
  header.readFrom(stream, version);
  return header;
}

Imf::Header checked_header(std::string_view bytes) {
  check_kind(bytes);
  check_attributes(bytes);
  return read_header(bytes);
}

ExrSize size_of(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const auto extent = [](int from, int to) { return std::int64_t{to} - from + 1; };
  return {extent(window.min.x, window.max.x), extent(window.min.y, window.max.y)};
}

void check_size(const Imf::Header& header, int width, int height) {
  const auto [columns, rows] = size_of(header);
  if (columns == width && rows == height) return;
  throw ImageError("The EXR has " + std::to_string(columns) + " x " + std::to_string(rows) +
                   " pixels; the frame has " + std::to_string(width) + " x " +
                   std::to_string(height) + ".");
}

void check_tiles(const Imf::Header& header) {
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tiles = header.tileDescription();
  const auto fits = [](std::uint32_t size) {
    return size >= smallest_tile && size <= largest_tile;
  };
  if (!fits(tiles.xSize) || !fits(tiles.ySize) || tiles.mode == Imf::RIPMAP_LEVELS) {
    throw ImageError(
        "The EXR's tiles are of an unusual kind; tiles of 8 to 2048 pixels, with "
        "or without smaller levels, are taken.");
  }
}

void check_channels(const Imf::Header& header, const std::vector<std::string>& wanted) {
  const Imf::ChannelList& there = header.channels();
  int count = 0;
  std::string names;
  for (auto each = there.begin(); each != there.end(); ++each, ++count) {
    names += (names.empty() ? "" : ", ") + std::string(each.name());
  }
  if (count > most_channels) {
    throw ImageError("The EXR has " + std::to_string(count) + " channels; at most " +
                     std::to_string(most_channels) + " are taken.");
  }
  for (const std::string& name : wanted) {
    const Imf::Channel* channel = there.findChannel(name);
    if (!channel) {
      throw ImageError("The EXR has no channel " + name + "; it has " +
                       (names.empty() ? "none" : names) + ".");
    }
    if (channel->type == Imf::UINT) {
      throw ImageError("The EXR's channel " + name +
                       " holds integers; half or float is taken.");
    }
    if (channel->xSampling != 1 || channel->ySampling != 1) {
      throw ImageError("The EXR's channel " + name + " does not have a value for every pixel.");
    }
  }
}

bool is_rec709(const Imf::Chromaticities& given) {
  const Imf::Chromaticities rec709;
  const auto near = [](const Imath::V2f& a, const Imath::V2f& b) {
    return (a - b).length() < 2e-3f;
  };
  return near(given.red, rec709.red) && near(given.green, rec709.green) &&
         near(given.blue, rec709.blue) && near(given.white, rec709.white);
}

void read_pixels(std::string_view bytes, const std::vector<std::string>& wanted, int width,
                 int height, ExrImage& image) {
  MemoryInput stream(bytes);
  Imf::InputFile file(stream, 0);  // on this thread, with one buffer of lines
  if (!file.isComplete()) ends_early();
  const Imath::Box2i window = file.header().dataWindow();
  Imf::FrameBuffer pixels;
  for (const std::string& name : wanted) {
    std::vector<float>& plane = image.planes.emplace_back(std::size_t(width) * height);
    pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float),
                                         sizeof(float) * static_cast<std::size_t>(width)));
  }
  file.setFrameBuffer(pixels);
  for (int y = window.min.y; y <= window.max.y; y += kLinesBetweenLooks) {
    look_up();
    file.readPixels(y, std::min(y + kLinesBetweenLooks - 1, window.max.y));
  }
}

void check_values(const ExrImage& image, const std::vector<std::string>& wanted, int width,
                  std::string_view endless) {
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    const std::vector<float>& plane = image.planes[c];
    const bool may_be_infinite = wanted[c] == endless;
    const auto bad = std::ranges::find_if(plane, [&](float value) {
      return std::isnan(value) || (!may_be_infinite && std::isinf(value));
    });
    if (bad == plane.end()) continue;
    const auto at = bad - plane.begin();
    throw ImageError("The EXR's channel " + wanted[c] + " is " +
                     (std::isnan(*bad) ? "not a number" : "infinite") + " at column " +
                     std::to_string(at % width) + ", row " + std::to_string(at / width) + ".");
  }
}

ExrImage read(std::string_view bytes, const std::vector<std::string>& wanted, int width,
              int height, std::string_view endless) {
  const Imf::Header header = checked_header(bytes);
  check_size(header, width, height);
  check_tiles(header);
  check_channels(header, wanted);
  ExrImage image;
  if (Imf::hasWhiteLuminance(header)) image.white_luminance = Imf::whiteLuminance(header);
  if (Imf::hasChromaticities(header)) image.rec709 = is_rec709(Imf::chromaticities(header));
  read_pixels(bytes, wanted, width, height, image);
  check_values(image, wanted, width, endless);
  return image;
}

}  // namespace

bool is_exr(std::string_view bytes) { return bytes.starts_with(magic); }

namespace {

/// What `read` gives; the library's errors, of many kinds, become ours.
template <class Read>
auto with_own_errors(Read read) {
  try {
    return read();
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const DeviceLost&) {  // of another's job, which the reading gave way to
    throw;
  } catch (const std::exception& error) {
    throw ImageError("The EXR cannot be read: " + std::string(error.what()));
  }
}

}  // namespace

ExrImage read_exr(std::string_view bytes, const std::vector<std::string>& channels, int width,
                  int height, std::string_view endless) {
  return with_own_errors([&] { return read(bytes, channels, width, height, endless); });
}

void check_rec709(const ExrImage& image) {
  if (image.rec709) return;
  throw ImageError("The EXR's chromaticities are not those of Rec. 709 with white D65.");
}

bool exr_has_channel(std::string_view bytes, const std::string& channel) {
  return with_own_errors(
      [&] { return checked_header(bytes).channels().findChannel(channel) != nullptr; });
}

ExrSize exr_size(std::string_view bytes) {
  return with_own_errors([&] { return size_of(checked_header(bytes)); });
}

}  // namespace cyanometer
