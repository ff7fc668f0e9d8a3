#include "server/log.h"

#include <poll.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <mutex>
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

/// A pipe with any room at all takes PIPE_BUF bytes, 4096, at once. A byte of a text may become
/// six in JSON; a path is the longest of a line, its method has plain characters.
void cut(nlohmann::ordered_json& line) {
  constexpr std::size_t most_bytes = 512;
  for (auto& member : line) {
    if (!member.is_string()) continue;
    auto& text = member.get_ref<std::string&>();
    if (text.size() > most_bytes) text = text.substr(0, most_bytes) + "...";
  }
}

bool would_be_taken() {
  pollfd errors{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&errors, 1, 0) > 0 && (errors.revents & POLLOUT) != 0;
}

}  // namespace

void start_log(const std::string& level) { logger().set_level(spdlog::level::from_str(level)); }

void log_line(spdlog::level::level_enum level, nlohmann::ordered_json line) {
  if (!logger().should_log(level)) return;
  cut(line);
  const auto text = line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  static std::mutex one_line;
  const std::lock_guard lock(one_line);
  if (would_be_taken()) logger().log(level, std::string_view(text).substr(1, text.size() - 2));
}

bool SparingLog::next() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  const std::int64_t second = std::chrono::duration_cast<std::chrono::seconds>(now).count();
  const std::lock_guard lock(mutex_);
  if (second != second_) {
    const int left_out = lines_ - most_lines_per_s;
    second_ = second;
    lines_ = 0;
    if (left_out > 0)
      log_line(spdlog::level::info, {{"event", event_}, {"lines_left_out", left_out}});
  }
  return ++lines_ <= most_lines_per_s;
}

void log_event(spdlog::level::level_enum level, const std::string& event) {
  log_line(level, {{"event", event}});
}

}  // namespace cyanometer
