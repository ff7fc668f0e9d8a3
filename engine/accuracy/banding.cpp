#include "engine/accuracy/banding.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace cyanometer {
namespace {

constexpr std::size_t flat_run = 8;

/// A row or a column of one channel.
struct Line {
  const unsigned char* rgbx;
  std::size_t first, stride, length;  ///< in pixels
  std::uint8_t channel;

  std::uint32_t pixel(std::size_t i) const {
    return static_cast<std::uint32_t>(first + i * stride);
  }
  int level(std::size_t i) const { return rgbx[4 * pixel(i) + channel]; }
};

void find_contours(const Line& line, const std::vector<bool>& counted,
                   std::vector<Contour>& found) {
  std::size_t run_before = 0, run_start = 0;
  auto end_of_run = [&](std::size_t end) {
    std::size_t run = end - run_start;
    if (run_before >= flat_run && run >= flat_run) {
      found.push_back(
          {line.pixel(run_start - 1), line.pixel(run_start), line.pixel(run_start - flat_run),
           line.pixel(run_start + flat_run - 1), line.channel,
           static_cast<std::int16_t>(line.level(run_start) - line.level(run_start - 1))});
    }
    run_before = run;
    run_start = end;
  };
  for (std::size_t i = 0; i < line.length; ++i) {
    if (!counted[line.pixel(i)]) {
      end_of_run(i);
      run_before = 0;
      run_start = i + 1;
    } else if (i > run_start && line.level(i) != line.level(i - 1)) {
      end_of_run(i);
    }
  }
  end_of_run(line.length);
}

}  // namespace

std::vector<Contour> contours(const unsigned char* rgbx, std::size_t width, std::size_t height,
                              const std::vector<bool>& counted) {
  std::vector<Contour> found;
  for (std::uint8_t c = 0; c < 3; ++c) {
    for (std::size_t y = 0; y < height; ++y) {
      find_contours({rgbx, y * width, 1, width, c}, counted, found);
    }
    for (std::size_t x = 0; x < width; ++x) {
      find_contours({rgbx, x, width, height, c}, counted, found);
    }
  }
  return found;
}

bool is_band(const Contour& contour, const std::function<Triple(std::size_t)>& levels) {
  int size = std::abs(contour.step);
  if (size < 2) return false;
  double change =
      levels(contour.last)[contour.channel] - levels(contour.first)[contour.channel];
  return size - std::copysign(change, change * contour.step) >= 1;
}

std::size_t pixels_beside(const std::vector<Contour>& contours, std::size_t pixels) {
  std::vector<bool> beside(pixels, false);
  for (const Contour& contour : contours) beside[contour.before] = beside[contour.after] = true;
  return static_cast<std::size_t>(std::ranges::count(beside, true));
}

}  // namespace cyanometer
