// An answer that has begun waits where a new request would be turned away.
#pragma once

#include <chrono>
#include <thread>

#include "server/queue/render_queue.h"

namespace cyanometer {

/// What `work` returns, tried again while the queue is full. @throws Cancelled by `watch`, and
/// what `work` throws
template <class Work>
auto patiently(const Watch& watch, const Work& work) {
  for (;;) {
    try {
      return work();
    } catch (const QueueFull&) {
      watch.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  }
}

}  // namespace cyanometer
