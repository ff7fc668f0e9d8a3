// Logs: one JSON object a line, on standard error.
#pragma once

#include <spdlog/common.h>

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cyanometer {

/// `level`: "debug", "info", "warning" or "error".
void start_log(const std::string& level);

/// Adds the time and the level to the members of `line`, texts of which are cut where they are
/// long. Never waits: a line that nobody takes is lost.
void log_line(spdlog::level::level_enum level, nlohmann::ordered_json line);
void log_event(spdlog::level::level_enum level, const std::string& event);

}  // namespace cyanometer
