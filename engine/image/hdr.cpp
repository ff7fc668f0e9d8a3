// Radiance's picture format [Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's file
// formats].
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "engine/attention.h"
#include "engine/display/displayed.h"
#include "engine/image/formats.h"

namespace cyanometer {
namespace {

using Rgbe = std::array<unsigned char, 4>;

/// A common exponent and three mantissas of 8 bits, rounded: nearly all readers take them as
/// they are (Radiance itself adds half a unit). What the format lacks is 0 (negative values,
/// NaN) or its largest value.
Rgbe to_rgbe(std::array<float, 3> rgb) {
  constexpr float kLargest = 0x1.fep126f;
  for (float& value : rgb) value = value > 0 ? std::min(value, kLargest) : 0.0f;
  const float largest = std::max({rgb[0], rgb[1], rgb[2]});
  if (largest < 0x1p-127f) return {};
  int exponent = 0;
  if (std::frexp(largest, &exponent) >= 255.5f / 256)
    ++exponent;  // its mantissa rounds up to 256
  // Not times a power of two: of the darkest colours that is more than a float holds.
  const auto mantissa = [exponent](float v) {
    return static_cast<unsigned char>(std::ldexp(v, 8 - exponent) + 0.5f);
  };
  return {mantissa(rgb[0]), mantissa(rgb[1]), mantissa(rgb[2]),
          static_cast<unsigned char>(exponent + 128)};
}

/// A colour beyond what the format holds keeps its luminance.
std::array<float, 3> inside(float r, float g, float b) {
  if (!(std::min({r, g, b}) < 0)) return {r, g, b};
  const Triple colour = into_gamut({r, g, b});
  return {static_cast<float>(colour[0]), static_cast<float>(colour[1]),
          static_cast<float>(colour[2])};
}

/// Runs as (128 + length, value), the rest as (length, values...).
void append_runs(std::string& file, const std::vector<unsigned char>& bytes) {
  constexpr std::size_t kShortestRun = 4, kLongestRun = 127, kLongestRest = 128;
  const auto run_at = [&](std::size_t i) {
    std::size_t n = 1;
    while (n < kLongestRun && i + n < bytes.size() && bytes[i + n] == bytes[i]) ++n;
    return n;
  };
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t end = i, run = 0;  // of what is no run
    while (end < bytes.size() && (run = run_at(end)) < kShortestRun) end += run;
    for (; i < end;) {
      const std::size_t n = std::min(end - i, kLongestRest);
      file += static_cast<char>(n);
      file.append(reinterpret_cast<const char*>(&bytes[i]), n);
      i += n;
    }
    if (i == bytes.size()) break;
    file += static_cast<char>(128 + run);
    file += static_cast<char>(bytes[i]);
    i += run;
  }
}

void append_row(std::string& file, const std::vector<Rgbe>& row) {
  const std::size_t width = row.size();
  if (width < 8 || width > 32767) {  // the run-length coding has no room for such a width
    for (const Rgbe& pixel : row) file.append(pixel.begin(), pixel.end());
    return;
  }
  file += "\x02\x02";
  file += static_cast<char>(width >> 8);
  file += static_cast<char>(width & 0xff);
  std::vector<unsigned char> component(width);
  for (std::size_t c = 0; c < 4; ++c) {
    std::transform(row.begin(), row.end(), component.begin(),
                   [c](const Rgbe& pixel) { return pixel[c]; });
    append_runs(file, component);
  }
}

const float* plane(const Frame& frame, std::string_view channel) {
  for (const Frame::Plane& plane : frame.planes)
    if (plane.channel == channel) return plane.samples;
  throw std::runtime_error("the frame has no channel " + std::string(channel));
}

std::string radiance_header(const Frame& frame) {
  std::string description = frame.description;
  std::replace(description.begin(), description.end(), '\n', ' ');  // one line, the same JSON
  std::string text = "#?RADIANCE\n# " + std::string(kDescriptionKey) + " " + description +
                     "\nFORMAT=32-bit_rle_rgbe\n"
                     "PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n";
  if (frame.white_luminance > 0) {
    // Radiance means W m^-2 sr^-1 at 179 lm/W after division by EXPOSURE.
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "EXPOSURE=%.9g\n", 179 / frame.white_luminance);
    text += line.data();
  }
  return text + "\n-Y " + std::to_string(frame.height) + " +X " + std::to_string(frame.width) +
         "\n";
}

}  // namespace

std::string encode_hdr(const Frame& frame, const Scene&) {
  const std::array<const float*, 3> rgb{plane(frame, "R"), plane(frame, "G"),
                                        plane(frame, "B")};
  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  std::string file = radiance_header(frame);
  std::vector<Rgbe> row(width);
  for (std::size_t y = 0; y < height; ++y) {
    look_up();
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      row[x] = to_rgbe(inside(rgb[0][i], rgb[1][i], rgb[2][i]));
    }
    append_row(file, row);
  }
  return file;
}

}  // namespace cyanometer
