// The encoders, one file each; registered in encode.cpp.
#pragma once

#include <string>
#include <string_view>

#include "engine/engine.h"

namespace cyanometer {

// All take a frame whose pixels are there (Frame::rgbx for PNG and JPEG, else planes) and
// return the file; they throw std::runtime_error with the library's own words when it fails.
// They look up between lines (engine/attention.h) where the library lets them: turbojpeg does
// not.
std::string encode_png(const Frame& frame, const Scene& scene);
std::string encode_exr(const Frame& frame, const Scene& scene);
std::string encode_jpeg(const Frame& frame, const Scene& scene);
std::string encode_hdr(const Frame& frame, const Scene& scene);
std::string encode_npy(const Frame& frame, const Scene& scene);

/// Under this name a file carries Frame::description.
inline constexpr std::string_view kDescriptionKey = "cyanometer";

/// Of an EXR: some blocks of the library's.
inline constexpr int kLinesBetweenLooks = 64;

}  // namespace cyanometer
