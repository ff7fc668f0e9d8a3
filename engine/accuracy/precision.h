// The error of methods due to the precision of the device's numbers alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct PrecisionPoint {
  double error = 0;  ///< in the contract's measure; of walks the mean difference, with its sign
  double noise = 0;  ///< of walks the standard error of that mean, else 0
};

/// Makes the same values with every operation of the device rounded to nearest, up, down and
/// towards zero. Each operation is wrong by less than a unit in its last place then, by half a
/// unit at most when rounded to nearest, and one-sided errors don't cancel: what the values
/// change is about what they are wrong by at most [Kahan 2006, How futile are mindless
/// assessments of roundoff in floating-point computation?]. It needs no second
/// program in double, and holds the tables' halves and the driver's own functions as they are.
class PrecisionTrial {
 public:
  /// @throws std::runtime_error on a device whose rounding can't be turned: only software ones
  explicit PrecisionTrial(const std::string& device);

  const DeviceDescription& device() const { return engines_.front().device(); }

  /// The method at its defaults along rays of the scene, at its wavelengths.
  /// @throws OverLimit, Cancelled
  PrecisionPoint measure(const Scene& scene, const std::string& method, const Watch& watch);
  /// By a plan.
  PrecisionPoint measure(const Scene& scene, const Plan& plan, const Watch& watch);

 private:
  std::array<Engine, 4> engines_;
};

/// A table in Markdown of scenes by methods(): its head, and one of its lines.
std::string precision_table_head();
std::string precision_table_line(const std::string& name,
                                 const std::vector<PrecisionPoint>& by_method);

}  // namespace cyanometer
