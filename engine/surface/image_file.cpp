#include "engine/surface/image_file.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <type_traits>

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

/// Closed when it is left, however.
struct PngFile {
  explicit PngFile(std::string_view bytes) {
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) fail();
    check_size(image.width, image.height);
  }
  ~PngFile() { png_image_free(&image); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  template <class Sample>
  std::vector<Sample> read(png_uint_32 format) {
    image.format = format;
    std::vector<Sample> samples(PNG_IMAGE_SIZE(image) / sizeof(Sample));
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
  PngFile file(bytes);
  file.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  MapPixels pixels = pixels_of(file.image.width, file.image.height, 3);
  std::vector<std::uint8_t> samples = file.read<std::uint8_t>(PNG_FORMAT_RGB);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    pixels.planes[i % 3][i / 3] = linear_from_srgb(static_cast<float>(samples[i]) / 255);
  }
  return pixels;
}

MapPixels png_heights(std::string_view bytes) {
  PngFile file(bytes);
  MapPixels pixels = pixels_of(file.image.width, file.image.height, 1);
  auto take = [&](const auto& samples, float white) {
    std::ranges::transform(samples, pixels.planes[0].begin(),
                           [&](auto v) { return static_cast<float>(v) / white; });
  };
  // In the format that the file is in nothing is converted.
  if (file.image.format & PNG_FORMAT_FLAG_LINEAR) {
    take(file.read<std::uint16_t>(PNG_FORMAT_LINEAR_Y), 65535);
  } else {
    take(file.read<std::uint8_t>(PNG_FORMAT_GRAY), 255);
  }
  return pixels;
}

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
  std::size_t channels = colours ? 3 : 1;
  MapPixels pixels = pixels_of(width, height, channels);
  std::vector<unsigned char> samples(channels * pixels.planes[0].size());
  if (tjDecompress2(decoder.get(), data, bytes.size(), samples.data(), width, 0, height,
                    colours ? TJPF_RGB : TJPF_GRAY, TJFLAG_STOPONWARNING) != 0) {
    fail();
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    float v = static_cast<float>(samples[i]) / 255;
    pixels.planes[i % channels][i / channels] = colours ? linear_from_srgb(v) : v;
  }
  return pixels;
}

MapPixels exr_pixels(std::string_view bytes, const std::vector<std::string>& channels) {
  ExrSize size = exr_size(bytes);
  check_size(size.width, size.height);
  auto width = static_cast<int>(size.width), height = static_cast<int>(size.height);
  MapPixels pixels{width, height, read_exr(bytes, channels, width, height).planes};
  for (std::vector<float>& plane : pixels.planes) {
    auto outside = std::ranges::find_if(plane, [](float v) { return v < 0 || v > 1; });
    if (outside == plane.end()) continue;
    throw ImageError("The EXR holds " + std::to_string(*outside) +
                     "; values from 0 to 1 are taken.");
  }
  return pixels;
}

MapPixels exr_heights(std::string_view bytes) {
  try {
    return exr_pixels(bytes, {"Y"});
  } catch (const ImageError&) {
    return exr_pixels(bytes, {"R"});
  }
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
  return exr_heights(bytes);
}

}  // namespace cyanometer
