#include "server/queue/plans.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/planner/nearby.h"
#include "engine/scene/document.h"
#include "engine/surface/surface_pass.h"

namespace cyanometer {
namespace {

constexpr std::size_t most_plans = 4096;
constexpr std::size_t longest_scene = 16384;  ///< bytes; with most_plans, some MiB in all
/// What planning takes, about; with `verify` it walks at random.
constexpr double planning_ms = 150, verifying_ms = 5000;

}  // namespace

Plans::Planned Plans::get(const Scene& scene, const std::string& client, const Watch& watch) {
  const auto start = std::chrono::steady_clock::now();
  const bool verify = scene.method.verify;
  const Scene alike = verify ? scene : nearby(scene);
  const std::string key =
      queue_.device().name + canonical(alike).dump() + ground_revision(alike);
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(key);
    if (found != known_.end()) return {.plan = found->second};
  }
  const auto make = [&](const Watch& shared) {
    Planned planned;
    const Ticket ticket = queue_.run({.client = client,
                                      .expected_ms = verify ? verifying_ms : planning_ms,
                                      .watch = shared,
                                      .work = [&](Engine& engine, const Watch& w) {
                                        planned.plan = engine.plan(scene, w);
                                        planned.lasting = queue_.ready();
                                      }});
    planned.queue_ms = ticket.queued_ms + ticket.given_away_ms;
    planned.place = ticket.place;
    return planned;
  };
  const auto landed = flights_.get(key, watch, make);
  Planned planned = *landed.value;
  if (landed.joined) planned.place.reset();
  const double took =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
          .count();
  planned.queue_ms = std::min(planned.queue_ms, took);  // less, where it began for another
  planned.ms = took - planned.queue_ms;
  if (!planned.lasting || key.size() > longest_scene) return planned;
  const std::lock_guard lock(mutex_);
  if (known_.size() >= most_plans) known_.clear();
  known_.emplace(key, planned.plan);
  return planned;
}

}  // namespace cyanometer
