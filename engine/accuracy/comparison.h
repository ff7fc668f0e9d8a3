// Two frames against each other, and the figures that say how much they differ.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/accuracy/error.h"
#include "engine/engine.h"

namespace cyanometer {

struct Comparison {
  ErrorMeasure measure;      ///< the contract's, over pixels whose rays meet air or ground
  double ciede2000_p99 = 0;  ///< of displayed pixels, with the reference's exposure
  /// Share of those pixels beside contours that the reference does not have
  /// (engine/accuracy/banding.h).
  double banding = 0;
  /// 95 % interval of the error, where it was measured on some of the pixels against a noisy
  /// reference.
  std::optional<std::array<double, 2>> error_95;
};

/// @throws SceneError, with pointers under /b, where the frames differ in size or in the way
/// that wavelengths become colours
void check_comparable(const Scene& a, const Scene& b);

/// The frames of two scenes without the sun's disc and stars, both displayed with the second's
/// exposure, tone map and white.
struct FramePair {
  Scene scene_b;
  Frame a, b;
  Frame linear_a, linear_b;  ///< the same with planes
};
/// @throws OverLimit, Cancelled, DeviceLost
FramePair render_pair(Engine& engine, const Scene& a, const Scene& b, const Watch& watch = {});

/// Of `a` against `b`; on any thread. @throws Cancelled
Comparison compare(const FramePair& frames, const Watch& watch = {});

/// The frame's pixels in the channels in which errors are measured, X, Y, Z or the three
/// radiances: those that count, one after another.
/// @param rgb  linear planes
std::vector<double> in_error_channels(const std::array<const float*, 3>& rgb, Colour colour,
                                      const std::vector<bool>& counted);

/// The mean over the channels of the signed relative difference d, by pixel; nan where a pixel
/// does not count.
std::vector<float> error_map(const std::array<const float*, 3>& a,
                             const std::array<const float*, 3>& b, Colour colour,
                             const std::vector<bool>& counted);
std::vector<float> error_map(const FramePair& frames);

/// The planes of the frame's image.
std::array<const float*, 3> image_planes(const Frame& frame);

}  // namespace cyanometer
