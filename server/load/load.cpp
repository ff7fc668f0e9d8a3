#include "server/load/load.h"

#include <httplib.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <cmath>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "server/load/daemon_time.h"
#include "server/load/whole_image.h"

namespace cyanometer {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

double cpu_seconds() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

/// The times from the start at which requests are due, s.
std::vector<double> arrivals(double rate, double seconds) {
  std::mt19937 random(1);
  std::exponential_distribution<double> pause(rate);
  std::vector<double> times;
  for (double t = pause(random); t < seconds; t += pause(random)) times.push_back(t);
  return times;
}

httplib::Headers credentials(const LoadSettings& settings) {
  if (settings.token.empty()) return {};
  return {{"Authorization", "Bearer " + settings.token}};
}

/// `queue;dur=0.012, prepare;dur=3.4`: into each stage its ms.
void note_stages(const std::string& server_timing, LoadReport& report) {
  constexpr std::string_view duration = ";dur=";
  std::istringstream stages(server_timing);
  for (std::string stage; std::getline(stages >> std::ws, stage, ',');) {
    const auto at = stage.find(duration);
    if (at == std::string::npos) continue;
    report.stage_ms[stage.substr(0, at)].push_back(
        std::strtod(stage.c_str() + at + duration.size(), nullptr));
  }
}

void note_frame(const httplib::Response& answer, LoadReport& report) {
  const auto field = [&](const char* name) { return answer.get_header_value(name); };
  report.truncated += !is_whole_image(answer.body, field("Content-Type"));
  report.kept += field("Cache-Status").find("hit") != std::string::npos;
  report.unmet += field("Cyanometer-Met") == "false";
  if (!answer.has_header("Cyanometer-Method")) return;
  report.methods.insert(field("Cyanometer-Method") + " " + field("Cyanometer-Options"));
  report.stated_error =
      std::max(report.stated_error, std::strtod(field("Cyanometer-Error").c_str(), nullptr));
  note_stages(field("Server-Timing"), report);
}

class Generator {
 public:
  explicit Generator(const LoadSettings& settings)
      : settings_(settings), motion_(settings.scene, settings.vary) {
    if (settings.rate) due_ = arrivals(*settings.rate, settings.seconds);
  }

  LoadReport run() {
    std::vector<LoadReport> parts(static_cast<std::size_t>(settings_.clients));
    std::vector<std::thread> threads;
    double cpu_before = 0;
    std::barrier connected(settings_.clients, [&]() noexcept {
      cpu_before = cpu_seconds();
      start_ = Clock::now();
    });
    for (auto& part : parts) {
      const std::size_t number = threads.size();
      threads.emplace_back([&, number] { be_a_client(number, connected, part); });
    }
    for (auto& thread : threads) thread.join();
    LoadReport all;
    all.seconds = settings_.seconds;
    all.cpu_s = cpu_seconds() - cpu_before;
    for (const auto& part : parts) add(part, all);
    return all;
  }

 private:
  template <class Barrier>
  void be_a_client(std::size_t number, Barrier& connected, LoadReport& report) {
    httplib::Client client(settings_.origin);
    const auto& sources = settings_.sources;
    if (!sources.empty()) client.set_interface(sources[number % sources.size()]);
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_read_timeout(600);
    client.Get("/healthz");
    connected.arrive_and_wait();
    for (;;) {
      const std::size_t i = next_++;
      Clock::time_point due = Clock::now();
      if (settings_.rate) {
        if (i >= due_.size()) return;
        due = start_ + std::chrono::nanoseconds(static_cast<std::int64_t>(due_[i] * 1e9));
        std::this_thread::sleep_until(due);
      } else if (!in_time(due)) {
        return;
      }
      ask(client, i, due, report);
    }
  }

  httplib::Result answer_to(httplib::Client& client, std::size_t i) const {
    const httplib::Headers headers = credentials(settings_);
    if (!settings_.get.empty()) return client.Get(settings_.get, headers);
    const std::size_t n = settings_.first + i;
    const json scene = settings_.scenes ? settings_.scenes(n) : motion_.frame(n);
    return client.Post("/v1/render", headers, scene.dump(), "application/json");
  }

  void ask(httplib::Client& client, std::size_t i, Clock::time_point due,
           LoadReport& report) const {
    const auto sent = Clock::now();
    const auto answer = answer_to(client, i);
    const auto done = Clock::now();
    report.late += ms_between(due, sent) > 10;
    report.asked += in_time(sent);
    const int status = answer ? answer->status : 0;
    ++report.statuses[status];
    if (status == 200) {
      report.frame_ms.push_back(ms_between(due, done));
      report.frames += in_time(done);
      note_frame(*answer, report);
    } else if (status == 429 || status == 503) {
      report.reject_ms.push_back(ms_between(sent, done));
      report.without_retry_after += !answer->has_header("Retry-After");
    }
  }

  bool in_time(Clock::time_point when) const {
    return ms_between(start_, when) < settings_.seconds * 1000;
  }

  static void add(const LoadReport& part, LoadReport& all) {
    const auto append = [](const std::vector<double>& from, std::vector<double>& to) {
      to.insert(to.end(), from.begin(), from.end());
    };
    for (const auto& [status, count] : part.statuses) all.statuses[status] += count;
    for (const auto& [stage, ms] : part.stage_ms) append(ms, all.stage_ms[stage]);
    append(part.frame_ms, all.frame_ms);
    append(part.reject_ms, all.reject_ms);
    all.methods.insert(part.methods.begin(), part.methods.end());
    all.stated_error = std::max(all.stated_error, part.stated_error);
    all.without_retry_after += part.without_retry_after;
    all.truncated += part.truncated;
    all.kept += part.kept;
    all.unmet += part.unmet;
    all.late += part.late;
    all.asked += part.asked;
    all.frames += part.frames;
  }

  const LoadSettings& settings_;
  Motion motion_;
  std::vector<double> due_;
  Clock::time_point start_;
  std::atomic<std::size_t> next_{0};
};

std::optional<double> daemon_seconds(httplib::Client& client, const LoadSettings& settings) {
  if (settings.daemon > 0) return process_seconds(settings.daemon);
  const auto metrics = client.Get("/metrics", credentials(settings));
  if (!metrics || metrics->status != 200) return std::nullopt;
  return metric_of(metrics->body, "process_cpu_seconds_total");
}

}  // namespace

double LoadReport::asked_per_s() const {
  return seconds > 0 ? static_cast<double>(asked) / seconds : 0;
}

double LoadReport::frames_per_s() const {
  return seconds > 0 ? static_cast<double>(frames) / seconds : 0;
}

std::size_t LoadReport::sent() const {
  std::size_t all = 0;
  for (const auto& [status, count] : statuses) all += count;
  return all;
}

LoadReport run_load(const LoadSettings& settings) {
  httplib::Client client(settings.origin);
  const auto answer = client.Get("/readyz");
  if (!answer || answer->status != 200) {
    throw std::runtime_error(
        settings.origin + " takes no requests: " +
        (answer ? std::to_string(answer->status) : httplib::to_string(answer.error())));
  }
  const auto before = daemon_seconds(client, settings);
  LoadReport report = Generator(settings).run();
  const auto after = daemon_seconds(client, settings);
  if (before && after) report.daemon_cpu_s = *after - *before;
  return report;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(rank));
  return values[rank];
}

json load_document(const LoadReport& report) {
  json statuses = json::object();
  for (const auto& [status, count] : report.statuses) {
    statuses[status == 0 ? "none" : std::to_string(status)] = count;
  }
  json stages = json::object();
  for (const auto& [stage, ms] : report.stage_ms) stages[stage] = quantile(ms, 0.5);
  const auto times = [](const std::vector<double>& ms) {
    return json{{"p50", quantile(ms, 0.5)}, {"p99", quantile(ms, 0.99)}};
  };
  const auto frames = static_cast<double>(report.frame_ms.size());
  const bool told = report.daemon_cpu_s && frames > 0;
  return {{"seconds", report.seconds},
          {"statuses", statuses},
          {"asked_per_s", report.asked_per_s()},
          {"frames_per_s", report.frames_per_s()},
          {"frame_ms", times(report.frame_ms)},
          {"stage_ms", stages},
          {"stated_error", report.stated_error},
          {"methods", report.methods},
          {"unmet", report.unmet},
          {"kept", report.kept},
          {"reject_ms", times(report.reject_ms)},
          {"without_retry_after", report.without_retry_after},
          {"truncated", report.truncated},
          {"late", report.late},
          {"frame_cpu_s", told ? json(*report.daemon_cpu_s / frames) : json()},
          {"generator_cpu_s", report.cpu_s}};
}

}  // namespace cyanometer
