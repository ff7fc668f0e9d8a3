// Plans, one for all scenes that are nearly alike, as the engine makes them. A plan is a
// function of scene, the files of its maps, version and device, so it is asked for once: a link
// that is still fresh is answered 304 without waiting behind a long render, and how long a
// frame takes is known before it waits.
#pragma once

#include <mutex>
#include <string>
#include <unordered_map>

#include "server/queue/render_queue.h"
#include "server/queue/single_flight.h"

namespace cyanometer {

class Plans {
 public:
  explicit Plans(RenderQueue& queue) : queue_(queue) {}
  struct Planned {
    Plan plan;
    double ms = 0;                    ///< that it took to get, but for waiting
    double queue_ms = 0;              ///< that it waited in the queue, and gave way to others
    std::optional<Place> place = {};  ///< in the queue, where it was waited for there
    bool lasting = true;  ///< false where the device was not ready: its profile may change
  };
  /// @throws as RenderQueue::run, and as ground_revision
  Planned get(const Scene& scene, const std::string& client, const Watch& watch);

 private:
  RenderQueue& queue_;
  std::mutex mutex_;
  std::unordered_map<std::string, Plan> known_;
  SingleFlight<Planned> flights_;
};

}  // namespace cyanometer
