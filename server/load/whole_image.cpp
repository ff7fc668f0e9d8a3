#include "server/load/whole_image.h"

#include <cstddef>
#include <cstdint>

namespace cyanometer {
namespace {

constexpr std::string_view png_end("IEND\xae\x42\x60\x82", 8), jpeg_start("\xff\xd8", 2),
    jpeg_end("\xff\xd9", 2), exr_start("\x76\x2f\x31\x01", 4);

/// Little-endian; 0 beyond the end.
std::uint64_t number_at(std::string_view bytes, std::uint64_t at, unsigned size) {
  if (at > bytes.size() || bytes.size() - at < size) return 0;
  std::uint64_t number = 0;
  for (unsigned i = 0; i < size; ++i) {
    number |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return number;
}

/// Behind the header: attributes of a name, a type, a size and a value, then an empty name.
/// Npos where it is cut off.
std::size_t end_of_exr_header(std::string_view bytes) {
  for (std::size_t at = 8; at < bytes.size();) {
    if (bytes[at] == '\0') return at + 1;
    const std::size_t name_end = bytes.find('\0', at);
    const std::size_t type_end = bytes.find('\0', name_end == bytes.npos ? at : name_end + 1);
    if (name_end == bytes.npos || type_end == bytes.npos) break;
    at = type_end + 5 + number_at(bytes, type_end + 1, 4);
  }
  return bytes.npos;
}

/// Chunks of scan lines follow a table of where they begin, up to the first of them; each says
/// how long it is, and the last ends the file.
bool is_whole_exr(std::string_view bytes) {
  const std::size_t table = end_of_exr_header(bytes);
  if (table == bytes.npos) return false;
  const std::uint64_t first = number_at(bytes, table, 8);
  if (first < table + 8 || first > bytes.size()) return false;
  const std::uint64_t last = number_at(bytes, first - 8, 8);
  return last >= first && last + 8 + number_at(bytes, last + 4, 4) == bytes.size();
}

}  // namespace

bool is_whole_image(std::string_view bytes, std::string_view media_type) {
  if (media_type == "image/png")
    return bytes.starts_with("\x89PNG") && bytes.ends_with(png_end);
  if (media_type == "image/jpeg") {
    return bytes.starts_with(jpeg_start) && bytes.ends_with(jpeg_end);
  }
  if (media_type == "image/x-exr") return bytes.starts_with(exr_start) && is_whole_exr(bytes);
  return true;
}

}  // namespace cyanometer
