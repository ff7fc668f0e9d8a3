// Images of surfaces, in files that an operator put there.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/exr_reader.h"

namespace cyanometer {

/// Columns and rows of the largest image that is taken.
inline constexpr int most_map_columns = 4096, most_map_rows = 2048;

/// Linear values from 0 to 1, rows from the top.
struct MapPixels {
  int width = 0, height = 0;
  std::vector<std::vector<float>> planes;  ///< red, green, blue; or heights alone
};

/// Colours of a PNG or JPEG (sRGB), or of an EXR (R, G, B; linear Rec. 709).
/// @param extension  png, jpg, exr
/// @throws ImageError where the bytes are no such file, are damaged, or the image is too large
/// or not twice as wide as high; where an EXR names other primaries
MapPixels read_colours(std::string_view bytes, const std::string& extension);

/// Heights, as they stand in the file, whatever it says of gamma: of a PNG in 8 or 16 bits, of
/// a JPEG, or of an EXR's Y or else R. Of a PNG or JPEG in colour they are the mean of red,
/// green and blue; opacity is left out. @throws ImageError as above
MapPixels read_heights(std::string_view bytes, const std::string& extension);

}  // namespace cyanometer
