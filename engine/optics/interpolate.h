// Linear interpolation in a table.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace cyanometer {

/// The value at `x` of the polyline through (xs, ys), constant beyond its ends. `xs` ascends
/// strictly and holds at least one number; `ys` has as many.
inline double interpolate(std::span<const double> xs, std::span<const double> ys, double x) {
  if (x <= xs.front()) return ys.front();
  if (x >= xs.back()) return ys.back();
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(xs, x) - xs.begin());
  const double t = (x - xs[above - 1]) / (xs[above] - xs[above - 1]);
  return ys[above - 1] + t * (ys[above] - ys[above - 1]);
}

}  // namespace cyanometer
