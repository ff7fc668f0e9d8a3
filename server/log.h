// Logs: one JSON object a line, on standard error.
#pragma once

#include <spdlog/common.h>

#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cyanometer {

/// `level`: "debug", "info", "warning" or "error".
void start_log(const std::string& level);

/// Adds the time and the level to the members of `line`, texts of which are cut where they are
/// long. Never waits: a line that nobody takes is lost.
void log_line(spdlog::level::level_enum level, nlohmann::ordered_json line);
void log_event(spdlog::level::level_enum level, const std::string& event);

/// Lines of a kind of which there may be thousands a second: so many are written that one sees
/// them, the others are counted.
class SparingLog {
 public:
  static constexpr int most_lines_per_s = 20;

  /// @param event  what the lines are about
  explicit SparingLog(std::string event) : event_(std::move(event)) {}
  /// Whether the next line is written. At a new second says how many were not in the last one.
  bool next();

 private:
  std::string event_;
  std::mutex mutex_;
  std::int64_t second_ = 0;
  int lines_ = 0;  ///< in this second
};

}  // namespace cyanometer
