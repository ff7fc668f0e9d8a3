// JPEG, quality 90, colour at full resolution; the description in comment segments.
#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "engine/image/formats.h"

namespace cyanometer {
namespace {

constexpr int kQuality = 90;

/// Comment segments that, joined, are the text; one holds 65533 bytes [ITU-T T.81, B.2.4.5].
std::string comments(std::string_view text) {
  constexpr std::size_t kMost = 65533;
  std::string segments;
  while (!text.empty()) {
    const std::string_view piece = text.substr(0, kMost);
    const std::size_t length = piece.size() + 2;
    segments += "\xff\xfe";
    segments += static_cast<char>(length >> 8);
    segments += static_cast<char>(length & 0xff);
    segments += piece;
    text.remove_prefix(piece.size());
  }
  return segments;
}

}  // namespace

std::string encode_jpeg(const Frame& frame, const Scene&) {
  const std::unique_ptr<std::remove_pointer_t<tjhandle>, int (*)(tjhandle)> encoder(
      tjInitCompress(), tjDestroy);
  if (!encoder) throw std::runtime_error(tjGetErrorStr2(nullptr));
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(encoder.get(), frame.rgbx, frame.width, 0, frame.height,
                                 TJPF_RGBX, &bytes, &size, TJSAMP_444, kQuality, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
  if (failed) throw std::runtime_error(tjGetErrorStr2(encoder.get()));

  std::string file(reinterpret_cast<char*>(bytes), size);
  // Start of image (2 bytes) and the JFIF segment (18) come first, as readers expect.
  return file.insert(20, comments(frame.description));
}

}  // namespace cyanometer
