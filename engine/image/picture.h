// Pictures that clients send: frames to be judged, and those that air is to be laid over.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "engine/image/exr_reader.h"
#include "engine/scene/scene.h"

namespace cyanometer {

/// R, G, B of an EXR of the frame's size in the frame's unit: one that says what its 1.0 means
/// (whiteLuminance) is scaled to what the frame's means.
/// @throws ImageError as read_exr does, and where colours are not of Rec. 709, the unit is not
/// finite, or what is scaled to the frame's is more than a float holds
ExrImage read_frame(std::string_view bytes, const Scene& scene);

/// What stands in the air and beyond it, seen by a frame's rays; rows from the top.
struct Picture {
  std::array<std::vector<float>, 3> rgb;  ///< linear, in the unit of the frame's own files
  /// Along the ray of each pixel; what is at 1e30 or farther lies beyond the air.
  std::vector<float> distance_km;
};

/// R, G, B and Z of an EXR of the frame's size; Z is the distance, km.
/// @param scale  of R, G, B to the frame's unit, beside what whiteLuminance says
/// @throws ImageError as read_frame does, and where a distance is negative
Picture read_picture(std::string_view bytes, const Scene& scene, double scale = 1);

}  // namespace cyanometer
