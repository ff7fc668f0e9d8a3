// Letters for labels: five by seven pixels.
#pragma once

namespace cyanometer {

constexpr int font_width = 5;
constexpr int font_height = 7;

/// Whether the letter covers the pixel. Small letters look like capitals; what is not a letter,
/// a digit, '-', '_' or '.' is blank.
bool font_pixel(char letter, int column, int row);

}  // namespace cyanometer
