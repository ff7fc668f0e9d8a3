// Errors by pixel as a picture: blue where it is too dark, red where it is too bright.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace cyanometer {

/// The colour, sRGB, of a signed relative difference: near-white up to 0.01 %, from there on to
/// 100 % by its logarithm, which ends at #3b4cc0 (-1) or #b40426 (1) [Moreland 2009: Diverging
/// color maps for scientific visualization], straight in CIELAB. The scale is the same for all
/// pictures.
std::array<unsigned char, 3> error_colour(double difference);

/// A PNG: the pixels above a bar with the scale. A picture narrower than the bar's labels
/// stands in the middle.
/// @param differences  rows from the top; nan is grey
std::string error_picture(const std::vector<float>& differences, int width, int height);

}  // namespace cyanometer
