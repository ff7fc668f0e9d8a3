// PNG [ISO/IEC 15948] with rows as differences of neighbours (filter SUB), compressed by ISA-L
// at its level 1: for the smooth pictures of skies five times faster than zlib's fastest, and
// no larger.
#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "engine/attention.h"
#include "engine/image/formats.h"

namespace cyanometer {
namespace {

void append_big_endian(std::string& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& file, std::string_view type, std::string_view data) {
  if (data.size() > 0x7fffffff) throw std::runtime_error("a chunk of 2 GiB and more");
  append_big_endian(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = file.size();
  file += type;
  file += data;
  const auto* covered = reinterpret_cast<const unsigned char*>(file.data() + start);
  append_big_endian(file, crc32_gzip_refl(0, covered, file.size() - start));
}

std::string image_header(const Frame& frame) {
  std::string data;
  append_big_endian(data, static_cast<std::uint32_t>(frame.width));
  append_big_endian(data, static_cast<std::uint32_t>(frame.height));
  return data +=
         std::string("\x08\x02\0\0\0", 5);  // 8 bits, RGB, deflate, filters, no interlace
}

/// An iTXt chunk's data: keyword, uncompressed, no language, no translated keyword, UTF-8.
std::string text(std::string_view keyword, std::string_view value) {
  std::string data(keyword);
  data += std::string(5, '\0');
  return data += value;
}

/// Deflates what it is given in pieces, into IDAT chunks of a zlib stream [RFC 1950].
class ImageData {
 public:
  explicit ImageData(std::string& file) : file_(file) {
    isal_deflate_init(&stream_);
    stream_.level = 1;
    stream_.level_buf = level_.data();
    stream_.level_buf_size = static_cast<std::uint32_t>(level_.size());
    stream_.gzip_flag = IGZIP_ZLIB;
    stream_.hist_bits = 15;
  }

  void write(std::vector<unsigned char>& bytes, bool last) {
    stream_.next_in = bytes.data();
    stream_.avail_in = static_cast<std::uint32_t>(bytes.size());
    stream_.end_of_stream = last;
    do {
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<std::uint32_t>(out_.size());
      if (isal_deflate(&stream_) != COMP_OK) throw std::runtime_error("deflate failed");
      const std::size_t made = out_.size() - stream_.avail_out;
      if (made) append_chunk(file_, "IDAT", {reinterpret_cast<char*>(out_.data()), made});
    } while (stream_.avail_out == 0);
  }

 private:
  std::string& file_;
  isal_zstream stream_{};
  std::vector<unsigned char> level_ = std::vector<unsigned char>(ISAL_DEF_LVL1_DEFAULT);
  std::vector<unsigned char> out_ = std::vector<unsigned char>(1 << 16);
};

/// One row as PNG stores it: the filter's number, then each byte less that of the pixel before.
void filter_row(const unsigned char* rgbx, std::size_t width, unsigned char* to) {
  *to++ = 1;
  for (int c = 0; c < 3; ++c) to[c] = rgbx[c];
  for (std::size_t x = 1; x < width; ++x)
    for (std::size_t c = 0; c < 3; ++c)
      to[3 * x + c] = static_cast<unsigned char>(rgbx[4 * x + c] - rgbx[4 * x + c - 4]);
}

}  // namespace

std::string encode_png(const Frame& frame, const Scene&) {
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", image_header(frame));
  append_chunk(file, "sRGB", std::string(1, '\0'));  // perceptual intent
  append_chunk(file, "iTXt", text(kDescriptionKey, frame.description));

  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  const std::size_t row_bytes = 1 + 3 * width;
  const std::size_t rows_at_once = std::max<std::size_t>(1, (std::size_t{1} << 17) / row_bytes);
  auto data = std::make_unique<ImageData>(file);
  std::vector<unsigned char> rows;
  for (std::size_t y = 0; y < height; y += rows_at_once) {
    look_up();
    const std::size_t count = std::min(rows_at_once, height - y);
    rows.resize(count * row_bytes);
    for (std::size_t i = 0; i < count; ++i)
      filter_row(frame.rgbx + 4 * width * (y + i), width, rows.data() + i * row_bytes);
    data->write(rows, y + count == height);
  }
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace cyanometer
