#include "server/queue/plans.h"

namespace cyanometer {
namespace {

constexpr std::size_t most_plans = 1024;
constexpr std::size_t longest_scene = 16384;  ///< bytes; with most_plans, some MiB in all

}  // namespace

Plan Plans::get(const Scene& scene, const std::string& canonical, const std::string& client,
                const Watch& watch) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(canonical);
    if (found != known_.end()) return found->second;
  }
  Plan plan;
  queue_.run({.client = client,
              .quick = true,
              .watch = watch,
              .work = [&](Engine& engine, const Watch& w) { plan = engine.plan(scene, w); }});
  if (canonical.size() > longest_scene) return plan;
  const std::lock_guard lock(mutex_);
  if (known_.size() >= most_plans) known_.clear();
  known_.emplace(canonical, plan);
  return plan;
}

}  // namespace cyanometer
