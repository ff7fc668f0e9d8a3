#include "server/load/load.h"

#include <httplib.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>

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

/// Of other types it is the length alone that tells, and the client looks at that.
bool is_cut_short(const httplib::Response& answer) {
  const std::string& png = answer.body;
  if (answer.get_header_value("Content-Type") != "image/png") return false;
  return !(png.starts_with("\x89PNG") && png.size() > 12 &&
           png.compare(png.size() - 8, 4, "IEND") == 0);
}

class Generator {
 public:
  explicit Generator(const LoadSettings& settings) : settings_(settings) {
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

  void ask(httplib::Client& client, std::size_t i, Clock::time_point due,
           LoadReport& report) const {
    const std::string scene = settings_.scene(settings_.first + i).dump();
    httplib::Headers headers;
    if (!settings_.token.empty()) headers.emplace("Authorization", "Bearer " + settings_.token);
    const auto sent = Clock::now();
    const auto answer = client.Post("/v1/render", headers, scene, "application/json");
    const auto done = Clock::now();
    report.late += ms_between(due, sent) > 10;
    report.asked += in_time(sent);
    const int status = answer ? answer->status : 0;
    ++report.statuses[status];
    if (status == 200) {
      report.frame_ms.push_back(ms_between(due, done));
      report.frames += in_time(done);
      report.truncated += is_cut_short(*answer);
    } else if (status == 429 || status == 503) {
      report.reject_ms.push_back(ms_between(sent, done));
      report.without_retry_after += !answer->has_header("Retry-After");
    }
  }

  bool in_time(Clock::time_point when) const {
    return ms_between(start_, when) < settings_.seconds * 1000;
  }

  static void add(const LoadReport& part, LoadReport& all) {
    for (const auto& [status, count] : part.statuses) all.statuses[status] += count;
    all.frame_ms.insert(all.frame_ms.end(), part.frame_ms.begin(), part.frame_ms.end());
    all.reject_ms.insert(all.reject_ms.end(), part.reject_ms.begin(), part.reject_ms.end());
    all.without_retry_after += part.without_retry_after;
    all.truncated += part.truncated;
    all.late += part.late;
    all.asked += part.asked;
    all.frames += part.frames;
  }

  const LoadSettings& settings_;
  std::vector<double> due_;
  Clock::time_point start_;
  std::atomic<std::size_t> next_{0};
};

}  // namespace

Scenes ever_brighter(json scene) {
  return [scene](std::size_t n) {
    json brighter = scene;
    brighter["image"]["exposure_ev"] = 1e-9 * static_cast<double>(n);
    return brighter;
  };
}

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
  return Generator(settings).run();
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
  return {
      {"seconds", report.seconds},
      {"statuses", statuses},
      {"asked_per_s", report.asked_per_s()},
      {"frames_per_s", report.frames_per_s()},
      {"frame_ms",
       {{"p50", quantile(report.frame_ms, 0.5)}, {"p99", quantile(report.frame_ms, 0.99)}}},
      {"reject_ms",
       {{"p50", quantile(report.reject_ms, 0.5)}, {"p99", quantile(report.reject_ms, 0.99)}}},
      {"without_retry_after", report.without_retry_after},
      {"truncated", report.truncated},
      {"late", report.late},
      {"generator_cpu_s", report.cpu_s}};
}

}  // namespace cyanometer
