// Pages of panels: what is bright where, and that every shape is drawn.
#include "engine/image/panels.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cyanometer {
namespace {

Panels ramp(int rows, int columns, int down, int across) {
  Panels panels;
  panels.title = "ramp";
  panels.rows.nodes = rows;
  panels.columns.nodes = columns;
  panels.down.nodes = down;
  panels.across.nodes = across;
  panels.wavelengths_nm = {550};
  panels.values.emplace_back();
  for (int i = 0; i < rows * columns * down * across; ++i) {
    panels.values[0].push_back(static_cast<float>(i));
  }
  return panels;
}

/// Pixels of a colour. The key has a few dozen of each grey.
int count(const Frame& frame, int red, int green, int blue) {
  int found = 0;
  for (int i = 0; i < frame.width * frame.height; ++i) {
    const unsigned char* p = frame.rgbx + 4 * i;
    found += p[0] == red && p[1] == green && p[2] == blue;
  }
  return found;
}
constexpr int most_of_key = 100;

TEST(Panels, TheBrightestValueIsWhiteAndNothingIsBlack) {
  Panels panels = ramp(1, 1, 1, 3);
  panels.values[0] = {0, 1e-3F, 1};
  Frame frame = picture_of(panels);
  for (int grey : {0, 128, 255}) EXPECT_GT(count(frame, grey, grey, grey), 10000) << grey;
}

TEST(Panels, FirstAndLastPanelsAreShownOfHoweverMany) {
  for (int columns : {2, 7, 8, 9, 63, 500}) {
    Panels panels = ramp(1, columns, 1, 1);
    std::ranges::fill(panels.values[0], 1e-3F);
    panels.values[0].front() = 0;
    panels.values[0].back() = 1;
    Frame frame = picture_of(panels);
    EXPECT_GT(count(frame, 0, 0, 0), most_of_key) << columns;
    EXPECT_GT(count(frame, 255, 255, 255), most_of_key) << columns;
    EXPECT_LT(frame.width, 1200) << columns;
  }
}

TEST(Panels, WavelengthsAreRedGreenAndBlueInTheirOrder) {
  Panels panels = ramp(1, 1, 1, 1), green = panels, blue = panels;
  panels.values[0] = {1};
  green.values[0] = {0};
  blue.values[0] = {0};
  append_wavelengths(green, panels);
  append_wavelengths(blue, panels);
  EXPECT_GT(count(picture_of(panels), 255, 0, 0), 10000);
}

}  // namespace
}  // namespace cyanometer
