// What every route may use.
#pragma once

#include <functional>
#include <string>

#include "server/admission.h"
#include "server/config.h"
#include "server/http/message.h"
#include "server/log.h"
#include "server/metrics.h"
#include "server/queue/frames.h"
#include "server/queue/plans.h"
#include "server/queue/render_queue.h"

namespace cyanometer {

struct Service {
  explicit Service(const Config& config_);

  Config config;
  Metrics metrics;
  RenderQueue queue;
  Admission admission{queue};
  Plans plans{queue};
  Frames frames;
  std::atomic<bool> draining{false};
  std::atomic<std::uint64_t> turned_away{0};  ///< requests that were told of a full queue
  SparingLog refusals{"turned away"};         ///< of those
  std::function<int()> connections = [] { return 0; };

  bool ready() const { return queue.ready() && !draining; }
  /// Given up when the request's client leaves or its deadline passes, counted from now: the
  /// server's, or the shorter one that the request asks for.
  /// @throws HttpProblem where it asks for one that is none, or longer
  Watch watch(const Request& request) const;
};

}  // namespace cyanometer
