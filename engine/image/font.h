// Letters for labels: five by seven pixels.
#pragma once

#include <array>
#include <string_view>

namespace cyanometer {

constexpr int font_width = 5;
constexpr int font_height = 7;

/// Whether the letter covers the pixel. Small letters look like capitals; what is not a letter,
/// a digit, '-', '+', '_', '.' or '%' is blank.
bool font_pixel(char letter, int column, int row);

/// Pixels of a line of text from its left to its right edge.
constexpr int text_width(std::string_view text) {
  return text.empty() ? 0 : static_cast<int>(text.size()) * (font_width + 1) - 1;
}

/// Paints the letters that end left of `right` into an image of `width` pixels, four bytes
/// each; (x, y) is the upper left corner. The caller sees to it that all of them lie inside.
void draw_text(unsigned char* rgbx, int width, int x, int y, int right, std::string_view text,
               const std::array<unsigned char, 3>& colour);

}  // namespace cyanometer
