#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

namespace cyanometer {
namespace {

spdlog::logger& logger() {
  static const auto log = [] {
    auto made = std::make_shared<spdlog::logger>(
        "cyanometer", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})",
                      spdlog::pattern_time_type::utc);
    made->set_level(spdlog::level::warn);
    return made;
  }();
  return *log;
}

}  // namespace

void start_log(const std::string& level) { logger().set_level(spdlog::level::from_str(level)); }

void log_line(spdlog::level::level_enum level, nlohmann::ordered_json line) {
  if (!logger().should_log(level)) return;
  const auto text = line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  logger().log(level, std::string_view(text).substr(1, text.size() - 2));
}

void log_event(spdlog::level::level_enum level, const std::string& event) {
  log_line(level, {{"event", event}});
}

}  // namespace cyanometer
