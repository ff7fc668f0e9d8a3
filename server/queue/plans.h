// Plans by scene. A plan is a function of scene, version and device, so it is asked for once: a
// link that is still fresh is answered 304 without waiting behind a long render.
#pragma once

#include <mutex>
#include <string>
#include <unordered_map>

#include "server/queue/render_queue.h"

namespace cyanometer {

class Plans {
 public:
  explicit Plans(RenderQueue& queue) : queue_(queue) {}
  /// `canonical` is the scene's canonical text. @throws as RenderQueue::run
  Plan get(const Scene& scene, const std::string& canonical, const std::string& client,
           const Watch& watch);

 private:
  RenderQueue& queue_;
  std::mutex mutex_;
  std::unordered_map<std::string, Plan> known_;
};

}  // namespace cyanometer
