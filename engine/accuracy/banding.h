// Contours in a displayed picture that its subject does not have.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/optics/colour.h"

namespace cyanometer {

/// A step from one pixel to the next, along a row or a column, between two flat runs of at
/// least eight pixels each: what an eye follows as a line. A run is flat where a channel stays
/// the same for all of it.
struct Contour {
  std::uint32_t before, after;  ///< pixels beside the step
  std::uint32_t first, last;    ///< the outermost of the sixteen pixels
  std::uint8_t channel;         ///< of R, G, B
  std::int16_t step;            ///< in levels
};

/// @param rgbx  displayed pixels, four bytes each
/// @param counted  [pixel]; sixteen pixels of which one is not counted hold no contour
std::vector<Contour> contours(const unsigned char* rgbx, std::size_t width, std::size_t height,
                              const std::vector<bool>& counted);

/// Whether the step is neither the eight bits' doing nor the subject's: it is of two levels or
/// more, where a smooth picture that is rounded has single ones between runs so long, and by
/// one at least larger than what the subject, displayed without rounding, changes by in its
/// direction across the same sixteen pixels. So neither edges nor slow gradients count, however
/// much brighter or darker the picture is than its subject; coarse tables, few samples and few
/// bits do.
/// @param levels  of the subject at a pixel, unrounded (Displayed::levels)
bool is_band(const Contour& contour, const std::function<Triple(std::size_t)>& levels);

/// Pixels beside the contours, each once.
std::size_t pixels_beside(const std::vector<Contour>& contours, std::size_t pixels);

}  // namespace cyanometer
