#include "engine/accuracy/banding.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cyanometer {
namespace {

constexpr std::size_t width = 256, height = 16;

/// A grey picture of a ramp along its rows.
struct Picture {
  std::function<double(std::size_t x)> level;
  std::vector<unsigned char> rgbx = std::vector<unsigned char>(width * height * 4);

  /// Rounded to every `coarseness`-th level.
  Picture(std::function<double(std::size_t)> level_, int coarseness)
      : level(std::move(level_)) {
    for (std::size_t i = 0; i < width * height; ++i) {
      double rounded = coarseness * std::floor(level(i % width) / coarseness + 0.5);
      for (std::size_t c = 0; c < 3; ++c) {
        rgbx[4 * i + c] = static_cast<unsigned char>(rounded);
      }
    }
  }
  std::vector<Contour> all(const std::vector<bool>& counted) const {
    return contours(rgbx.data(), width, height, counted);
  }
};

/// The share of the picture's pixels beside contours that the smooth subject does not have.
double banding(const Picture& picture, const std::function<double(std::size_t)>& subject) {
  auto found = picture.all(std::vector<bool>(width * height, true));
  std::erase_if(found, [&](const Contour& contour) {
    return !is_band(contour, [&](std::size_t pixel) {
      double level = subject(pixel % width);
      return Triple{level, level, level};
    });
  });
  return static_cast<double>(pixels_beside(found, width * height)) / (width * height);
}

auto ramp(double levels_a_pixel, double from = 50) {
  return [=](std::size_t x) { return from + levels_a_pixel * static_cast<double>(x); };
}

TEST(Banding, RoundingToEightBitsIsNone) {
  for (double slope : {0.0, 0.004, 0.03, 0.1, 0.3, 1.0, -0.05}) {
    EXPECT_EQ(banding({ramp(slope, 150), 1}, ramp(slope, 150)), 0) << slope;
    // Nor where the picture is brighter than its subject, steeper, or goes the other way.
    EXPECT_EQ(banding({ramp(slope, 150.7), 1}, ramp(slope, 150)), 0) << slope;
    EXPECT_EQ(banding({ramp(0.1 * slope, 150), 1}, ramp(slope, 150)), 0) << slope;
    EXPECT_EQ(banding({ramp(-0.1 * slope, 150), 1}, ramp(slope, 150)), 0) << slope;
  }
}

TEST(Banding, CoarseStepsInASlowRampAre) {
  // Three levels every 60 pixels: two pixels beside each of four steps.
  EXPECT_NEAR(banding({ramp(0.05), 3}, ramp(0.05)), 4 * 2.0 / width, 1e-9);
}

TEST(Banding, AStepWhereTheSubjectIsFlatIs) {
  auto step = [](std::size_t x) { return x < 100 ? 80.0 : 82.0; };
  EXPECT_NEAR(banding({step, 1}, [](std::size_t) { return 80.0; }), 2.0 / width, 1e-9);
}

TEST(Banding, AnEdgeThatTheSubjectHasIsNone) {
  auto horizon = [](std::size_t x) { return x < 100 ? 80.0 : 30.0; };
  EXPECT_EQ(banding({horizon, 1}, horizon), 0);
  // Nor where it is a pixel off.
  EXPECT_EQ(banding({horizon, 1}, [&](std::size_t x) { return horizon(x + 1); }), 0);
}

TEST(Banding, StepsThatFollowSoonAreNoContours) {
  // Three levels every seven pixels: no run is long enough to be seen as flat.
  EXPECT_EQ(banding({ramp(3.0 / 7), 3}, ramp(0)), 0);
}

TEST(Banding, RunsThroughPixelsThatDoNotCountAreNone) {
  Picture picture([](std::size_t x) { return x < 100 ? 80.0 : 84.0; }, 1);
  std::vector<bool> counted(width * height, true);
  EXPECT_EQ(picture.all(counted).size(), 3 * height);
  for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = i % width != 104;
  EXPECT_TRUE(picture.all(counted).empty());
}

}  // namespace
}  // namespace cyanometer
