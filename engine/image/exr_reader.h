// OpenEXR files from strangers: some channels of one flat image, of a size that is known.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cyanometer {

/// A file that is refused; says what is wrong with it.
struct ImageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Whether the bytes begin as an OpenEXR file does.
bool is_exr(std::string_view bytes);

struct ExrImage {
  std::vector<std::vector<float>> planes;  ///< [wanted channel][pixel], rows from the top
  std::optional<double> white_luminance;   ///< cd/m^2 of 1.0, where the file says it
  bool rec709 = true;                      ///< false where it names other primaries or white
};

/// Reads the wanted channels, half or float. Nothing is allocated that the file's bytes and the
/// wanted size do not bound.
/// @param channels  their names in the file: "R", "Z"
/// @param endless  the channel that may be infinite, if any
/// @throws ImageError where the bytes are no OpenEXR file, are cut off or damaged; where the
/// file is deep, has several parts or another size, lacks a channel, keeps it as integers or
/// for some pixels only; where a value is not finite
ExrImage read_exr(std::string_view bytes, const std::vector<std::string>& channels, int width,
                  int height, std::string_view endless = {});

/// @throws ImageError where its colours are not those of Rec. 709
void check_rec709(const ExrImage& image);

/// Columns and rows, from the header alone. @throws ImageError
struct ExrSize {
  std::int64_t width = 0, height = 0;
};
ExrSize exr_size(std::string_view bytes);

/// From the header alone. @throws ImageError
bool exr_has_channel(std::string_view bytes, const std::string& channel);

}  // namespace cyanometer
