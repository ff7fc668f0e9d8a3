#include "engine/image/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/problem.h"

namespace cyanometer {
namespace {

/// Of the file's colours to the frame's.
double unit_scale(const ExrImage& image, const Scene& scene) {
  if (scene.spectrum.colour != Colour::cie) return 1;
  check_rec709(image);
  if (!image.white_luminance) return 1;
  if (!std::isfinite(*image.white_luminance)) {
    throw ImageError("The EXR's whiteLuminance is " + std::to_string(*image.white_luminance) +
                     "; it is a number of cd/m^2, or 0 where that is not known.");
  }
  if (*image.white_luminance <= 0) return 1;
  return *image.white_luminance / Output{}.white_luminance;
}

/// The first three planes.
void scale_colours(ExrImage& image, double scale, int width) {
  if (scale == 1) return;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float>& plane = image.planes[c];
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const double scaled = plane[i] * scale;
      if (std::abs(scaled) > std::numeric_limits<float>::max()) {
        throw ImageError("The EXR's channel " + std::string(1, "RGB"[c]) + " at column " +
                         std::to_string(i % width) + ", row " + std::to_string(i / width) +
                         " is more than a float holds once it is scaled to the frame's unit.");
      }
      plane[i] = static_cast<float>(scaled);
    }
  }
}

void check_distances(const std::vector<float>& km, int width) {
  const auto bad = std::ranges::find_if(km, [](float d) { return d < 0; });
  if (bad == km.end()) return;
  const auto at = bad - km.begin();
  throw ImageError("The EXR's channel Z is negative at column " + std::to_string(at % width) +
                   ", row " + std::to_string(at / width) +
                   "; it is a distance in km, infinite or at least 1e30 for the sky.");
}

}  // namespace

ExrImage read_frame(std::string_view bytes, const Scene& scene) {
  ExrImage image = read_exr(bytes, {"R", "G", "B"}, scene.image.width, scene.image.height);
  scale_colours(image, unit_scale(image, scene), scene.image.width);
  return image;
}

Picture read_picture(std::string_view bytes, const Scene& scene, double scale) {
  ExrImage image =
      read_exr(bytes, {"R", "G", "B", "Z"}, scene.image.width, scene.image.height, "Z");
  check_distances(image.planes[3], scene.image.width);
  scale_colours(image, scale * unit_scale(image, scene), scene.image.width);
  auto& planes = image.planes;
  return {{std::move(planes[0]), std::move(planes[1]), std::move(planes[2])},
          std::move(planes[3])};
}

}  // namespace cyanometer
