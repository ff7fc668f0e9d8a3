// Frame to bytes, on any thread.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct Encoding {
  ImageFormat format;
  std::string_view name;                     ///< as in `image.format`
  std::string_view media_type;               ///< "image/png", "image/x-exr", "image/jpeg",
                                             ///< "image/vnd.radiance", "application/x-npy"
  std::vector<std::string_view> extensions;  ///< the first is the usual one
  bool displayed;  ///< wants Frame::rgbx; the others want linear planes
  int most_rows = std::numeric_limits<int>::max();  ///< that a file of it may have
};
/// All formats; the place where an encoder is registered.
const std::vector<Encoding>& encodings();
const Encoding& encoding(ImageFormat format);

/// The frame as a file. What a format cannot carry (layers outside EXR) was refused with the
/// scene.
/// @throws std::runtime_error naming the format when a library fails
std::string encode(const Frame& frame, const Scene& scene);

}  // namespace cyanometer
