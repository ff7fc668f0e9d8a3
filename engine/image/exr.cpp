// OpenEXR: all planes as they are named, with the precision of a half and, where one needs it,
// the range of a float.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#include "engine/attention.h"
#include "engine/image/formats.h"

namespace cyanometer {
namespace {

class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(std::string& bytes) : OStream("memory"), bytes_(bytes) {}
  void write(const char c[], int n) override {
    bytes_.resize(std::max(bytes_.size(), position_ + static_cast<std::size_t>(n)));
    std::memcpy(bytes_.data() + position_, c, static_cast<std::size_t>(n));
    position_ += static_cast<std::size_t>(n);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

 private:
  std::string& bytes_;
  std::size_t position_ = 0;
};

/// Whether a half overflows, or is denormal and so has fewer bits than it should, by the bits
/// of a float but for its sign.
bool needs_float(std::uint32_t size) {
  constexpr std::uint32_t largest = 0x477fe000, infinite = 0x7f800000,
                          least_normal = 0x38800000;
  return (size > largest && size < infinite) || (size > 0 && size < least_normal);
}

bool needs_float(const Frame& frame, std::size_t pixels) {
  return std::ranges::any_of(frame.planes, [&](const Frame::Plane& plane) {
    bool any = false;  // without a branch, which compilers make vectors of
    for (std::size_t i = 0; i < pixels; ++i)
      any |= needs_float(std::bit_cast<std::uint32_t>(plane.samples[i]) & 0x7fffffff);
    return any;
  });
}

half stored(float value, half) { return half(value); }

/// With the 11 significant bits of a half and the range of a float: what is below is the
/// method's and rounding's noise, and does not compress.
float stored(float value, float) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (!std::isfinite(value)) return value;
  return std::bit_cast<float>((bits + 0xfff + (bits >> 13 & 1)) & ~std::uint32_t{0x1fff});
}

Imf::Header make_header(const Frame& frame, const Scene& scene) {
  Imf::Header header(frame.width, frame.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  // Of a sky two thirds of the usual level's time, and half as large again.
  header.zipCompressionLevel() = 1;
  header.insert(std::string(kDescriptionKey), Imf::StringAttribute(frame.description));
  if (scene.image.channels == Channels::rgb)
    Imf::addChromaticities(header, Imf::Chromaticities());  // by default those of Rec. 709, D65
  if (frame.white_luminance > 0)
    Imf::addWhiteLuminance(header, static_cast<float>(frame.white_luminance));
  // A cubemap is no OpenEXR environment: there each face is the mirror image of OpenGL's.
  if (scene.camera.projection == Projection::equirectangular)
    Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  return header;
}

/// All planes as samples of the one type, some lines at a time.
template <class Sample>
void write(const Frame& frame, Imf::Header header, Imf::PixelType type, std::string& bytes) {
  const auto width = static_cast<std::size_t>(frame.width);
  for (const Frame::Plane& plane : frame.planes)
    header.channels().insert(plane.channel, Imf::Channel(type));
  MemoryOutput stream(bytes);
  Imf::OutputFile file(stream, header);
  const int lines = std::min(kLinesBetweenLooks, frame.height);
  std::vector<Sample> samples(frame.planes.size() * lines * width);
  for (int y = 0; y < frame.height; y += lines) {
    look_up();
    const auto count = static_cast<std::size_t>(std::min(lines, frame.height - y));
    Imf::FrameBuffer pixels;
    for (std::size_t i = 0; i < frame.planes.size(); ++i) {
      const float* from = frame.planes[i].samples + y * width;
      Sample* to = samples.data() + i * lines * width;
      std::transform(from, from + count * width, to,
                     [](float value) { return stored(value, Sample()); });
      // A slice counts from a first line of its own.
      pixels.insert(frame.planes[i].channel,
                    Imf::Slice(type, reinterpret_cast<char*>(to) - y * width * sizeof(Sample),
                               sizeof(Sample), width * sizeof(Sample)));
    }
    file.setFrameBuffer(pixels);
    file.writePixels(static_cast<int>(count));
  }
}

/// OpenEXR's pool of threads is one for the process, and empty until it is given a size.
void use_all_cores() {
  static const bool once = [] {
    Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
    return true;
  }();
  (void)once;
}

}  // namespace

std::string encode_exr(const Frame& frame, const Scene& scene) {
  use_all_cores();
  const std::size_t pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const Imf::Header header = make_header(frame, scene);
  std::string bytes;
  if (needs_float(frame, pixels)) {
    write<float>(frame, header, Imf::FLOAT, bytes);
  } else {
    write<half>(frame, header, Imf::HALF, bytes);
  }
  return bytes;
}

}  // namespace cyanometer
