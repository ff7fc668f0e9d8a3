#include "engine/image/encode.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "engine/image/formats.h"

namespace cyanometer {
namespace {

struct Encoder {
  Encoding encoding;
  std::string (*encode)(const Frame&, const Scene&);
};

constexpr bool kDisplayed = true, kLinear = false;

const std::vector<Encoder>& encoders() {
  static const std::vector<Encoder> all{
      {{ImageFormat::png, "png", "image/png", {".png"}, kDisplayed}, encode_png},
      {{ImageFormat::exr, "exr", "image/x-exr", {".exr"}, kLinear}, encode_exr},
      // As libjpeg has it [jmorecfg.h]; columns are fewer by the scene.
      {{ImageFormat::jpeg, "jpeg", "image/jpeg", {".jpg", ".jpeg"}, kDisplayed, 65500},
       encode_jpeg},
      {{ImageFormat::hdr, "hdr", "image/vnd.radiance", {".hdr", ".pic"}, kLinear}, encode_hdr},
      {{ImageFormat::npy, "npy", "application/x-npy", {".npy"}, kLinear}, encode_npy},
  };
  return all;
}

const Encoder& encoder(ImageFormat format) {
  return *std::find_if(encoders().begin(), encoders().end(), [&](const Encoder& encoder) {
    return encoder.encoding.format == format;
  });
}

void require_pixels(const Frame& frame, const Encoding& encoding) {
  if (frame.width < 1 || frame.height < 1) throw std::runtime_error("the frame has no size");
  if (encoding.displayed ? !frame.rgbx : frame.planes.empty())
    throw std::runtime_error(encoding.displayed ? "the frame has no displayed pixels"
                                                : "the frame has no linear planes");
}

}  // namespace

const std::vector<Encoding>& encodings() {
  static const std::vector<Encoding> all = [] {
    std::vector<Encoding> result;
    for (const Encoder& encoder : encoders()) result.push_back(encoder.encoding);
    return result;
  }();
  return all;
}

const Encoding& encoding(ImageFormat format) { return encoder(format).encoding; }

std::string encode(const Frame& frame, const Scene& scene) {
  const Encoder& chosen = encoder(scene.image.format);
  try {
    require_pixels(frame, chosen.encoding);
    return chosen.encode(frame, scene);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string(chosen.encoding.name) + ": " + error.what());
  }
}

}  // namespace cyanometer
