// Who is turned away before the request is read: under overload that costs a tenth of finding
// it out when the scene is parsed and planned.
#pragma once

#include <cstddef>
#include <mutex>
#include <unordered_set>

#include "server/http/message.h"
#include "server/queue/render_queue.h"

namespace cyanometer {

class Admission {
 public:
  explicit Admission(RenderQueue& queue) : queue_(queue) {}

  /// For requests that take a place in the queue. What is wrong with one is then not said: who
  /// comes back when there is room is told.
  /// @throws QueueFull where a job of the request's client would be refused now, unless its
  /// like was remembered
  void check(const Request& request);
  /// That such a request may need no place: its frame may be kept, or in flight.
  void remember(const Request& request);

 private:
  RenderQueue& queue_;
  std::mutex mutex_;
  std::unordered_set<std::size_t> remembered_;  ///< hashes: who is taken for another is read
};

}  // namespace cyanometer
