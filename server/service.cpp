#include "server/service.h"

#include "engine/cache_folder.h"

#include <spdlog/spdlog.h>

#include "server/log.h"

namespace cyanometer {

Service::Service(const Config& config_)
    : config(config_),
      queue({.engine = {.device = config_.device,
                        .table_bytes = config_.cache_bytes(),
                        .profiles = cache_folder("profiles")},
             .capacity = static_cast<std::size_t>(config_.queue),
             .frame_bytes = config_.frame_bytes(),
             .log = [](const std::string& event) { log_event(spdlog::level::err, event); }}) {}

Watch Service::watch(const Request& request) const {
  Watch watch;
  watch.gone = request.gone;
  watch.deadline =
      std::chrono::steady_clock::now() +
      std::chrono::milliseconds(static_cast<std::int64_t>(config.deadline_s * 1000));
  return watch;
}

}  // namespace cyanometer
