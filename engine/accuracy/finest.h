// The best solution that needs no random numbers, and the colours of its rays.
#pragma once

#include <vector>

#include "engine/engine.h"
#include "engine/optics/colour.h"
#include "engine/problem.h"

namespace cyanometer {

/// The finest setting of `moments`, or of `raymarch` where one order is asked for.
/// @param wavelengths_nm  those of the scene, or more or fewer
Plan finest_plan(const Scene& scene, const std::vector<double>& wavelengths_nm);

/// The scene's wavelengths; where it leaves the choice, so many that colour is within a
/// tenth of a percent.
std::vector<double> converged_wavelengths(const Scene& scene);

/// From spectral radiances per unit of the sun's irradiance to channels.
class RayColours {
 public:
  RayColours(const Scene& scene, const std::vector<double>& wavelengths_nm);

  /// X, Y, Z or the wavelengths: [ray][channel], as errors are measured in.
  std::vector<std::vector<double>> error_channels(
      const std::vector<std::vector<double>>& radiance) const;
  /// Linear Rec. 709 or the three radiances, in the image's unit. @param radiance of one ray
  Triple rgb(const std::vector<double>& radiance) const;
  const Output& output() const { return output_; }

 private:
  Triple sum(const std::array<std::vector<double>, 3>& rows,
             const std::vector<double>& radiance) const;
  Output output_;
};

/// A part of a longer work: its progress runs between these shares of the whole's.
Watch part_of(const Watch& watch, double from, double to);

}  // namespace cyanometer
