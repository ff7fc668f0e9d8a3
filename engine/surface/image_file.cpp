#include "engine/surface/image_file.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace cyanometer {
namespace {

/// Before anything is allocated for its pixels.
void check_size(std::int64_t width, std::int64_t height) {
  std::string size =
      "The image has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; ";
  if (width > most_map_columns || height > most_map_rows) {
    throw ImageError(size + std::to_string(most_map_columns) + " x " +
                     std::to_string(most_map_rows) + " are the most that are taken.");
  }
  if (width < 2 || width != 2 * height) {
    throw ImageError(size + "an equirectangular one is twice as wide as high.");
  }
}

MapPixels pixels_of(std::int64_t width, std::int64_t height, std::size_t planes) {
  check_size(width, height);
  return {static_cast<int>(width), static_cast<int>(height),
          std::vector(planes, std::vector<float>(static_cast<std::size_t>(width * height)))};
}

float linear_from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// From 0 to 1. @param bytes  of a sample: 1, or 2 with the higher first
float mean_of_channels(const unsigned char* pixel, int channels, int bytes) {
  int sum = 0;
  for (int c = 0; c < channels; ++c, pixel += bytes) {
    sum += bytes == 1 ? pixel[0] : pixel[0] << 8 | pixel[1];
  }
  return static_cast<float>(sum) / static_cast<float>(channels * (bytes == 1 ? 255 : 65535));
}

// ---- PNG: colours as the file means them, by what libpng calls its simplified API; heights as
// they stand in it, which that API does not give

/// Closed when it is left, however.
struct ColourPng {
  explicit ColourPng(std::string_view bytes) {
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) fail();
    check_size(image.width, image.height);
  }
  ~ColourPng() { png_image_free(&image); }
  ColourPng(const ColourPng&) = delete;
  ColourPng& operator=(const ColourPng&) = delete;

  std::vector<std::uint8_t> read() {
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> samples(PNG_IMAGE_SIZE(image));
    const png_color black{0, 0, 0};  // what lies behind transparent pixels
    if (!png_image_finish_read(&image, &black, samples.data(), 0, nullptr)) fail();
    return samples;
  }
  [[noreturn]] void fail() const {
    throw ImageError("The PNG cannot be read: " + std::string(image.message));
  }

  png_image image{};
};

MapPixels png_colours(std::string_view bytes) {
  ColourPng file(bytes);
  file.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  MapPixels pixels = pixels_of(file.image.width, file.image.height, 3);
  std::vector<std::uint8_t> samples = file.read();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    pixels.planes[i % 3][i / 3] = linear_from_srgb(static_cast<float>(samples[i]) / 255);
  }
  return pixels;
}

struct PlainPng {
  explicit PlainPng(std::string_view bytes) : rest(bytes) {}
  ~PlainPng() { png_destroy_read_struct(&png, &info, nullptr); }
  PlainPng(const PlainPng&) = delete;
  PlainPng& operator=(const PlainPng&) = delete;

  /// libpng leaves a step that fails by a jump: it may hold nothing that is to be destroyed.
  template <class Step>
  void take(Step step) {
    if (!png || !info) throw std::bad_alloc();
    if (setjmp(png_jmpbuf(png))) {
      throw ImageError("The PNG cannot be read: " + std::string(why.data()));
    }
    step();
  }
  static void fail(png_structp png, png_const_charp why) {
    auto& file = *static_cast<PlainPng*>(png_get_error_ptr(png));
    std::snprintf(file.why.data(), file.why.size(), "%s", why);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}
  static void copy(png_structp png, png_bytep to, std::size_t count) {
    auto& rest = static_cast<PlainPng*>(png_get_io_ptr(png))->rest;
    if (count > rest.size()) png_error(png, "it ends early");
    std::memcpy(to, rest.data(), count);
    rest.remove_prefix(count);
  }

  std::string_view rest;
  std::array<char, 128> why{};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
};

MapPixels png_heights(std::string_view bytes) {
  PlainPng file(bytes);
  file.take([&] {
    png_set_read_fn(file.png, &file, PlainPng::copy);
    png_read_info(file.png, file.info);
  });
  MapPixels pixels = pixels_of(png_get_image_width(file.png, file.info),
                               png_get_image_height(file.png, file.info), 1);
  // Whole bytes, grey or colours; of gamma nothing is undone where nothing asks for it.
  file.take([&] {
    png_set_expand(file.png);
    png_set_strip_alpha(file.png);
    png_set_interlace_handling(file.png);
    png_read_update_info(file.png, file.info);
  });
  const int channels = png_get_channels(file.png, file.info),
            sample_bytes = png_get_bit_depth(file.png, file.info) / 8;
  const std::size_t row_bytes = png_get_rowbytes(file.png, file.info);
  std::vector<unsigned char> samples(row_bytes * static_cast<std::size_t>(pixels.height));
  std::vector<png_bytep> rows;
  for (int y = 0; y < pixels.height; ++y) rows.push_back(samples.data() + row_bytes * y);
  file.take([&] { png_read_image(file.png, rows.data()); });
  for (std::size_t i = 0; i < pixels.planes[0].size(); ++i) {
    pixels.planes[0][i] =
        mean_of_channels(samples.data() + i * channels * sample_bytes, channels, sample_bytes);
  }
  return pixels;
}

// ---- JPEG and EXR

MapPixels jpeg_pixels(std::string_view bytes, bool colours) {
  const std::unique_ptr<std::remove_pointer_t<tjhandle>, int (*)(tjhandle)> decoder(
      tjInitDecompress(), tjDestroy);
  auto fail = [&] {
    throw ImageError("The JPEG cannot be read: " + std::string(tjGetErrorStr2(decoder.get())));
  };
  auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, sampling = 0, space = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &sampling,
                          &space) != 0) {
    fail();
  }
  MapPixels pixels = pixels_of(width, height, colours ? 3 : 1);
  const std::size_t count = pixels.planes[0].size();
  std::vector<unsigned char> samples(3 * count);
  // Heights too: libjpeg's own grey is a luma.
  if (tjDecompress2(decoder.get(), data, bytes.size(), samples.data(), width, 0, height,
                    TJPF_RGB, TJFLAG_STOPONWARNING) != 0) {
    fail();
  }
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned char* pixel = &samples[3 * i];
    if (!colours) {
      pixels.planes[0][i] = mean_of_channels(pixel, 3, 1);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      pixels.planes[c][i] = linear_from_srgb(static_cast<float>(pixel[c]) / 255);
    }
  }
  return pixels;
}

MapPixels exr_pixels(std::string_view bytes, const std::vector<std::string>& channels) {
  ExrSize size = exr_size(bytes);
  check_size(size.width, size.height);
  auto width = static_cast<int>(size.width), height = static_cast<int>(size.height);
  ExrImage image = read_exr(bytes, channels, width, height);
  if (channels.size() == 3) check_rec709(image);
  MapPixels pixels{width, height, std::move(image.planes)};
  for (std::vector<float>& plane : pixels.planes) {
    auto outside = std::ranges::find_if(plane, [](float v) { return v < 0 || v > 1; });
    if (outside == plane.end()) continue;
    throw ImageError("The EXR holds " + std::to_string(*outside) +
                     "; values from 0 to 1 are taken.");
  }
  return pixels;
}

}  // namespace

MapPixels read_colours(std::string_view bytes, const std::string& extension) {
  if (extension == "png") return png_colours(bytes);
  if (extension == "jpg") return jpeg_pixels(bytes, true);
  return exr_pixels(bytes, {"R", "G", "B"});
}

MapPixels read_heights(std::string_view bytes, const std::string& extension) {
  if (extension == "png") return png_heights(bytes);
  if (extension == "jpg") return jpeg_pixels(bytes, false);
  return exr_pixels(bytes, {exr_has_channel(bytes, "Y") ? "Y" : "R"});
}

}  // namespace cyanometer
