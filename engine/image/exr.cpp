// OpenEXR: all planes as they are named, half where that loses nothing but the mantissa's tail.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cmath>
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

/// True where a half overflows, or is denormal and so has fewer bits than it should.
bool needs_float(float value) {
  const float size = std::fabs(value);
  return (size > 65504.0f && std::isfinite(value)) || (size > 0 && size < 0x1p-14f);
}

bool needs_float(const Frame& frame, std::size_t pixels) {
  return std::any_of(frame.planes.begin(), frame.planes.end(), [&](const Frame::Plane& plane) {
    return std::any_of(plane.samples, plane.samples + pixels,
                       [](float value) { return needs_float(value); });
  });
}

Imf::Header make_header(const Frame& frame, const Scene& scene) {
  Imf::Header header(frame.width, frame.height);
  header.compression() = Imf::ZIP_COMPRESSION;
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

void write(const Frame& frame, Imf::Header header, Imf::PixelType type,
           std::size_t sample_bytes, const std::vector<const char*>& samples,
           std::string& bytes) {
  Imf::FrameBuffer pixels;
  for (std::size_t i = 0; i < frame.planes.size(); ++i) {
    header.channels().insert(frame.planes[i].channel, Imf::Channel(type));
    pixels.insert(frame.planes[i].channel,
                  Imf::Slice(type, const_cast<char*>(samples[i]), sample_bytes,
                             sample_bytes * static_cast<std::size_t>(frame.width)));
  }
  MemoryOutput stream(bytes);
  Imf::OutputFile file(stream, header);
  file.setFrameBuffer(pixels);
  for (int y = 0; y < frame.height; y += kLinesBetweenLooks) {
    look_up();
    file.writePixels(std::min(kLinesBetweenLooks, frame.height - y));
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
  std::vector<const char*> samples;
  if (needs_float(frame, pixels)) {
    for (const Frame::Plane& plane : frame.planes)
      samples.push_back(reinterpret_cast<const char*>(plane.samples));
    write(frame, header, Imf::FLOAT, sizeof(float), samples, bytes);
    return bytes;
  }
  std::vector<half> halves(pixels * frame.planes.size());
  auto to = halves.begin();
  for (const Frame::Plane& plane : frame.planes) {
    samples.push_back(reinterpret_cast<const char*>(&*to));
    to = std::copy(plane.samples, plane.samples + pixels, to);
  }
  write(frame, header, Imf::HALF, sizeof(half), samples, bytes);
  return bytes;
}

}  // namespace cyanometer
