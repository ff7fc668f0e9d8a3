// NumPy's format 1.0: float32 of the shape (height, width, channels).
#include <bit>
#include <cstdint>
#include <cstring>

#include "engine/attention.h"
#include "engine/image/formats.h"

namespace cyanometer {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are written as they lie");

std::string npy_header(const Frame& frame) {
  std::string fields = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(frame.height) + ", " + std::to_string(frame.width) +
                       ", " + std::to_string(frame.planes.size()) + "), }";
  constexpr std::size_t kPrefix = 10,
                        kAlignment = 64;  // magic, version, length; start of the data
  while ((kPrefix + fields.size() + 1) % kAlignment) fields += ' ';
  fields += '\n';
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(fields.size() & 0xff);
  file += static_cast<char>(fields.size() >> 8);
  return file + fields;
}

}  // namespace

std::string encode_npy(const Frame& frame, const Scene&) {
  const std::size_t pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const std::size_t channels = frame.planes.size();
  std::string file = npy_header(frame);
  const std::size_t start = file.size();
  file.resize(start + pixels * channels * sizeof(float));
  for (std::size_t c = 0; c < channels; ++c) {
    look_up();
    for (std::size_t i = 0; i < pixels; ++i)
      std::memcpy(file.data() + start + (i * channels + c) * sizeof(float),
                  frame.planes[c].samples + i, sizeof(float));
  }
  return file;
}

}  // namespace cyanometer
