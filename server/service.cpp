#include "server/service.h"

#include <spdlog/spdlog.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "engine/cache_folder.h"
#include "engine/surface/maps.h"
#include "server/http/problem.h"
#include "server/log.h"

namespace cyanometer {

Service::Service(const Config& config_)
    : config(config_),
      queue({.engine = {.device = config_.device,
                        .table_bytes = config_.table_bytes(),
                        .kernels = static_cast<std::size_t>(config_.kernels),
                        .profiles = cache_folder("profiles")},
             .capacity = static_cast<std::size_t>(config_.queue),
             .frame_bytes = config_.frame_bytes(),
             .log = [](const std::string& event) { log_event(spdlog::level::err, event); },
             .warm = config_.warm,
             .faults = config_.faults}),
      frames(queue, config_.kept_frame_bytes()) {
  // `render --frames` has said before any command where they are.
  if (!config.surfaces.empty()) use_surfaces(config.surfaces, config.surface_bytes());
}

namespace {

/// The header Cyanometer-Deadline, in seconds.
double deadline_of(const Request& request, double longest_s) {
  const std::string given = request.header("cyanometer-deadline");
  if (given.empty()) return longest_s;
  double seconds = 0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), seconds);
  const bool number = error == std::errc{} && end == given.data() + given.size();
  const bool sound = number && std::isfinite(seconds) && seconds > 0;
  if (sound && seconds <= longest_s) return seconds;
  HttpProblem problem(sound ? 422 : 400,
                      sound ? "Cyanometer-Deadline is longer than this server's."
                            : "Cyanometer-Deadline is not a positive number of seconds.");
  problem.given = given;
  std::ostringstream allowed;
  allowed << "seconds above 0, up to " << longest_s;
  problem.allowed = allowed.str();
  throw problem;
}

}  // namespace

Watch Service::watch(const Request& request) const {
  Watch watch;
  watch.gone = request.gone;
  watch.deadline =
      std::chrono::steady_clock::now() + std::chrono::microseconds(static_cast<std::int64_t>(
                                             deadline_of(request, config.deadline_s) * 1e6));
  return watch;
}

}  // namespace cyanometer
