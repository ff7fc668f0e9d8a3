#include "server/routes/steady_plans.h"

#include <cmath>

namespace cyanometer {
namespace {

/// What keeping a method may cost, over the one that would be chosen now.
constexpr double most_time = 2;
/// Where nothing meets what was asked: over the error of the best.
constexpr double most_error = 1.2;

bool same_choice(const Plan& a, const Plan& b) {
  return a.method == b.method && a.options == b.options;
}

/// As many as either had: colours do not jump when fewer would do.
void keep_wavelengths(const Plan& before, Plan& plan) {
  if (before.wavelengths_nm.size() > plan.wavelengths_nm.size()) {
    plan.wavelengths_nm = before.wavelengths_nm;
  }
}

}  // namespace

PlannedFrame SteadyPlans::next(const SceneRequest& asked, const Watch& watch) {
  PlannedFrame planned = plan_frame(asked, client_, service_, watch);
  if (asked.scene.method.name == "auto") {
    const bool open = asked.scene.spectrum.wavelengths_nm.empty();
    if (before_ && open) keep_wavelengths(*before_, planned.plan);
    if (before_ && !same_choice(*before_, planned.plan)) {
      keep_method(asked, planned.plan, watch);
    }
    planned.tag = frame_tag(asked, planned.plan, service_);
  }
  before_ = planned.plan;
  return planned;
}

/// True where the method of the frame before does for this one, and is now the plan's.
bool SteadyPlans::keep_method(const SceneRequest& asked, Plan& plan, const Watch& watch) const {
  Scene scene = asked.scene;
  const MethodChoice wanted = scene.method;
  const bool open = scene.spectrum.wavelengths_nm.empty();
  scene.method = {};
  scene.method.name = before_->method;
  scene.method.options = before_->options;
  scene.method.scattering_orders = wanted.scattering_orders;
  scene.spectrum.wavelengths_nm = plan.wavelengths_nm;
  const Plan kept = service_.plans.get(scene, client_, watch).plan;
  // The wavelengths were chosen for half of the error at the most.
  const double spectral = open ? wanted.max_error.value_or(plan.expected_error) / 2 : 0;
  const double error = std::hypot(kept.expected_error, spectral);
  const bool exact = plan.met ? wanted.max_error && error <= *wanted.max_error
                              : error <= most_error * plan.expected_error;
  const bool in_time = kept.expected_ms <= most_time * plan.expected_ms &&
                       (!wanted.max_ms || kept.expected_ms <= *wanted.max_ms);
  if (!exact || !in_time) return false;
  plan.method = kept.method;
  plan.options = kept.options;
  plan.expected_error = error;
  plan.expected_ms = kept.expected_ms;
  return true;
}

}  // namespace cyanometer
