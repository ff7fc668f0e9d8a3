// What to do for a scene: the named method as asked, or for `auto` the cheapest choice that
// meets the error or the time; and the bound that is stated with it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/methods/method.h"
#include "engine/planner/profile.h"

namespace cyanometer {

/// Traces some rays of the scene and returns what they show, without the sun's disc and stars,
/// in the channels in which errors are measured: [ray][channel].
using TraceProbe = std::function<std::vector<std::vector<double>>(
    const std::string& method, const MethodOptions& options,
    const std::vector<double>& wavelengths_nm)>;

/// How much a request asks for.
struct Extent {
  double rays = 0;    ///< that meet air or ground
  double pixels = 0;  ///< that are stored and displayed; 0 of rays from a list
  /// Rays of a frame where the values between them are interpolated to `tolerance`; 0 of what
  /// is not made so.
  double sparse_rays = 0;
  static constexpr double tolerance = 0.002;

  /// Whether such options interpolate it, and the rays that are traced then.
  bool is_sparse(const MethodOptions& options) const;
  double traced(const MethodOptions& options) const;
};

struct PlanInputs {
  const Scene& scene;
  Extent extent;  ///< of the whole request
  const std::vector<std::unique_ptr<Method>>& methods;
  const DeviceProfile& profile;
  TraceProbe probe;    ///< the same few rays each time
  bool parts = false;  ///< whether rays end at something in the air
};

/// Every error is measured on the probe's rays: against the best solution that is quick, at the
/// finest setting of its ladder, whose own error is told from the setting before, and from
/// random walks where the scene is one in which all settings may be wrong alike; or, where the
/// scene asks to `verify`, against random walks, which takes seconds and owes nothing to a
/// model.
Plan make_plan(const PlanInputs& inputs);

/// Time on the device that a plan reckons with, ms.
/// @param problem  the scene at a few wavelengths
double expected_ms(const DeviceProfile& profile, const Method& method,
                   const MethodOptions& options, const Problem& problem, Extent extent,
                   std::size_t wavelengths);

}  // namespace cyanometer
