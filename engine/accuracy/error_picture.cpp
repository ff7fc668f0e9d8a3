#include "engine/accuracy/error_picture.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/image/encode.h"
#include "engine/image/font.h"
#include "engine/optics/ciede2000.h"

namespace cyanometer {
namespace {

using Pixel = std::array<unsigned char, 3>;

constexpr Pixel dark{0x3b, 0x4c, 0xc0}, white{0xf7, 0xf7, 0xf7}, bright{0xb4, 0x04, 0x26};
constexpr Pixel outside{0x60, 0x60, 0x60}, margin{0xff, 0xff, 0xff}, ink{0x20, 0x20, 0x20};

constexpr double decades = 4;  ///< from 0.01 % to 100 %

Triple lab_of(const Pixel& pixel) {
  return lab_from_srgb({pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0});
}

unsigned char encoded(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  double srgb =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<unsigned char>(std::lround(255 * srgb));
}

/// @param position  -1 to 1 on the scale
Pixel colour_at(double position) {
  static const Triple ends[]{lab_of(dark), lab_of(bright)}, middle = lab_of(white);
  const Triple& end = ends[position > 0];
  Triple lab;
  for (std::size_t c = 0; c < 3; ++c) lab[c] = std::lerp(middle[c], end[c], std::abs(position));
  Triple linear = rec709_from_xyz() * xyz_from_lab(lab);
  return {encoded(linear[0]), encoded(linear[1]), encoded(linear[2])};
}

double position_of(double difference) {
  double size = 1 + std::log10(std::max(std::abs(difference), 1e-300)) / decades;
  return std::copysign(std::clamp(size, 0.0, 1.0), difference);
}

struct Canvas {
  int width, height;
  std::vector<unsigned char> rgbx;

  Canvas(int width_, int height_)
      : width(width_), height(height_), rgbx(std::size_t(width_) * height_ * 4) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) set(x, y, margin);
    }
  }
  void set(int x, int y, const Pixel& colour) {
    std::ranges::copy(colour, &rgbx[(std::size_t(y) * width + x) * 4]);
  }
};

constexpr int gap = 6, bar_height = 12, tick = 3, least_width = 360;
constexpr int legend_height = gap + bar_height + tick + 2 + font_height + gap;

/// The bar, from -100 % to 100 %, with a tick and a label at each decade.
void draw_legend(Canvas& canvas, int top) {
  const int left = 20, right = canvas.width - 21;
  auto column = [&](double position) {
    return static_cast<int>(std::lround((left + right + position * (right - left)) / 2));
  };
  for (int x = left; x <= right; ++x) {
    Pixel colour = colour_at((2.0 * x - left - right) / (right - left));
    for (int y = 0; y < bar_height; ++y) canvas.set(x, top + gap + y, colour);
  }
  for (const auto& [position, label] : {std::pair{-1.0, "-100%"},
                                        {-0.75, "-10%"},
                                        {-0.5, "-1%"},
                                        {-0.25, "-0.1%"},
                                        {0.0, "0.01%"},
                                        {0.25, "+0.1%"},
                                        {0.5, "+1%"},
                                        {0.75, "+10%"},
                                        {1.0, "+100%"}}) {
    int x = column(position), y = top + gap + bar_height;
    for (int i = 0; i < tick; ++i) canvas.set(x, y + i, ink);
    draw_text(canvas.rgbx.data(), canvas.width, x - text_width(label) / 2, y + tick + 2,
              canvas.width, label, ink);
  }
}

}  // namespace

Pixel error_colour(double difference) { return colour_at(position_of(difference)); }

std::string error_picture(const std::vector<float>& differences, int width, int height) {
  // As many colours as 8 bits tell apart.
  constexpr int steps = 1024;
  std::vector<Pixel> map;
  for (int i = -steps; i <= steps; ++i) map.push_back(colour_at(double(i) / steps));
  Canvas canvas(std::max(width, least_width), height + legend_height);
  int left = (canvas.width - width) / 2;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float d = differences[std::size_t(y) * width + x];
      canvas.set(
          left + x, y,
          std::isnan(d)
              ? outside
              : map[static_cast<std::size_t>(steps + std::lround(steps * position_of(d)))]);
    }
  }
  draw_legend(canvas, height);
  Frame frame;
  frame.width = canvas.width;
  frame.height = canvas.height;
  frame.rgbx = canvas.rgbx.data();
  frame.description = nlohmann::json{{"version", version()}}.dump();
  return encode(frame, Scene());
}

}  // namespace cyanometer
