#include "engine/methods/bruneton/pictures.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace cyanometer::bruneton {
namespace {

/// The pixels of a picture, kept alive by its frame.
struct Pixels {
  std::vector<std::vector<float>> planes;
  std::vector<unsigned char> rgbx;
};

/// A table of `directions` next to each other, then suns, then altitudes, group by group.
struct Layout {
  int altitudes, suns, zeniths, azimuths;

  int width() const { return suns * azimuths; }
  int height() const { return altitudes * zeniths; }
  /// Of the texel at a pixel, within a group.
  std::size_t texel(int x, int y) const {
    std::size_t place = std::size_t{1} * (y / zeniths) * suns + x / azimuths;
    return (place * zeniths + y % zeniths) * azimuths + x % azimuths;
  }
};

std::vector<float> read_plane(const std::vector<glm::vec4>& values, const Layout& layout,
                              std::size_t wavelength, bool logarithmic) {
  std::size_t size = std::size_t{1} * layout.width() * layout.height();
  std::vector<float> plane;
  for (int y = 0; y < layout.height(); ++y) {
    for (int x = 0; x < layout.width(); ++x) {
      float value =
          values[wavelength / 4 * size + layout.texel(x, y)][static_cast<int>(wavelength % 4)];
      plane.push_back(logarithmic ? std::exp(value) : value);
    }
  }
  return plane;
}

/// Four decades below the brightest value to black, evenly in the logarithm; the first and the
/// last wavelengths are red and blue.
std::vector<unsigned char> display(const std::vector<std::vector<float>>& planes) {
  constexpr double decades = 4;
  double brightest = 1e-30;
  for (const auto& plane : planes) {
    brightest = std::max<double>(brightest, *std::ranges::max_element(plane));
  }
  std::vector<unsigned char> rgbx;
  std::size_t last = planes.size() - 1;
  for (std::size_t i = 0; i < planes.front().size(); ++i) {
    for (std::size_t w : {std::size_t{0}, last / 2, last}) {
      double depth = std::log10(std::max(planes[w][i] / brightest, 1e-30));
      rgbx.push_back(static_cast<unsigned char>(
          std::lround(255 * std::clamp(1 + depth / decades, 0.0, 1.0))));
    }
    rgbx.push_back(255);
  }
  return rgbx;
}

TablePicture picture(const std::string& name, const std::string& axes,
                     const vulkan::Buffer& buffer, const Layout& layout,
                     const std::vector<double>& wavelengths_nm, bool logarithmic) {
  std::vector<glm::vec4> values(buffer.size() / sizeof(glm::vec4));
  buffer.read(0, std::as_writable_bytes(std::span(values)));
  auto pixels = std::make_shared<Pixels>();
  TablePicture picture{name, axes, {}};
  picture.frame.width = layout.width();
  picture.frame.height = layout.height();
  for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
    pixels->planes.push_back(read_plane(values, layout, w, logarithmic));
  }
  for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
    char channel[32];
    std::snprintf(channel, sizeof channel, "%gnm", wavelengths_nm[w]);
    picture.frame.planes.push_back({channel, pixels->planes[w].data()});
  }
  pixels->rgbx = display(pixels->planes);
  picture.frame.rgbx = pixels->rgbx.data();
  picture.frame.storage = pixels;
  return picture;
}

Layout layout_of(const ScatteringGrid& grid) {
  return {grid.altitudes, grid.suns, grid.zeniths, grid.azimuths};
}

}  // namespace

std::vector<TablePicture> pictures(TableMaker& maker, Tracer& tracer,
                                   const UploadedScene& scene, const Setup& setup) {
  auto sources = maker.source(tracer, scene, setup);
  auto view = maker.view(tracer, scene, setup);
  const std::string suns = "across suns, from the lowest to the zenith, and in each azimuths ";
  const std::string below = "; down altitudes, from the ground up, and in each ";
  auto of = [&](const std::string& name, const std::string& axes, const vulkan::Buffer& buffer,
                const Layout& layout) {
    return picture(name, axes, buffer, layout, scene.problem().wavelengths_nm,
                   setup.logarithmic);
  };
  std::vector<TablePicture> all;
  all.push_back(of("source", suns + "from the sun" + below + "zenith angles from 0 to 180 deg",
                   sources->source, layout_of(sources->grid)));
  all.push_back(of("irradiance", "across suns, from the lowest to the zenith",
                   sources->irradiance, {1, sources->grid.suns, 1, 1}));
  all.push_back(of("view", suns + "from the sun" + below + "views from the nadir to the zenith",
                   view->values, layout_of(view->rays.rays.grid)));
  return all;
}

}  // namespace cyanometer::bruneton
