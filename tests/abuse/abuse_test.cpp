// Laws of a daemon under abuse; the figures are printed.
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <random>

#include "server/load/load.h"
#include "tests/abuse/crowd.h"
#include "tests/api/program.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int number_from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

/// A daemon in a process of its own, ready.
struct Served {
  explicit Served(const std::vector<std::string>& settings = {})
      : run(with(settings)), port(run.port()), ops_port(run.port("ops_port")) {
    for (int i = 0; i < 6000 && !ready(); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_TRUE(ready()) << run.err();
  }
  static std::vector<std::string> with(const std::vector<std::string>& settings) {
    std::vector<std::string> all{"serve", "--listen", "127.0.0.1:0", "--ops-listen",
                                 "127.0.0.1:0"};
    all.insert(all.end(), settings.begin(), settings.end());
    return all;
  }
  httplib::Client client() const {
    httplib::Client made("127.0.0.1", port);
    made.set_tcp_nodelay(true);
    made.set_read_timeout(60);
    return made;
  }
  bool ready() const {
    const auto answer = httplib::Client("127.0.0.1", ops_port).Get("/readyz");
    return answer && answer->status == 200;
  }
  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port); }
  double metric(const std::string& name) const {
    const auto text = httplib::Client("127.0.0.1", ops_port).Get("/metrics")->body;
    const auto at = text.find("\n" + name + " ");
    return at == std::string::npos ? -1 : std::stod(text.substr(at + name.size() + 2));
  }
  double resident_mib() const {
    std::ifstream in("/proc/" + std::to_string(run.pid()) + "/statm");
    double total = 0, resident = 0;
    in >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576;
  }
  /// The fewest of a second: connections that are just closing do not count.
  std::size_t open_files() const {
    const std::filesystem::path folder = "/proc/" + std::to_string(run.pid()) + "/fd";
    std::ptrdiff_t fewest = 1 << 20;
    for (int i = 0; i < 10; ++i) {
      std::this_thread::sleep_for(100ms);
      fewest = std::min(fewest, std::distance(std::filesystem::directory_iterator(folder), {}));
    }
    return static_cast<std::size_t>(fewest);
  }

  Program run;
  int port, ops_port;
};

json tiny_scene() { return {{"image", {{"width", 64}, {"height", 36}}}}; }

/// Other scenes each time, so that none has been kept.
LoadReport load(LoadSettings& settings) {
  LoadReport report = run_load(settings);
  settings.first += report.sent();
  return report;
}

/// Frames a second of the time that the generator left to the daemon: it works on the same
/// processors, and what asking takes there is none of the daemon's doing.
double frames_per_s_left(const LoadReport& report) {
  const double cores = std::thread::hardware_concurrency();
  return static_cast<double>(report.frame_ms.size()) / (report.seconds - report.cpu_s / cores);
}

/// Peak and overload in turn, so that what else goes on here meets both: each overload is held
/// against the peaks before and after it. The law is about the daemon: at ten times what it can
/// do it makes as many frames as at its peak, 95 % of them at least, in the time that the
/// generator leaves it, which asks ten times as much then. What came without that reckoning is
/// reported beside it.
void overload(const json& scene, int rounds) {
  Served served;
  LoadSettings settings;
  settings.origin = served.origin();
  settings.scene = scene;
  const auto peak = [&] {
    settings.clients = 16;
    settings.rate.reset();
    settings.seconds = 5;
    return load(settings);
  };
  peak();  // plans, pipelines, the pacer
  std::vector<LoadReport> peaks{peak()};
  std::vector<double> peak_rates{peaks.back().frames_per_s()}, rates, ratios, ratios_left,
      rejects;
  double cpu_s = 0, seconds = 0;
  for (int round = 0; round < rounds; ++round) {
    settings.rate = 10 * peak_rates.back();
    settings.clients = 300;  // beyond three quarters of the threads idle ones are let go
    const LoadReport over = load(settings);
    peaks.push_back(peak());
    const auto against_the_peaks = [&](auto rate) {
      return 2 * rate(over) / (rate(peaks[peaks.size() - 2]) + rate(peaks.back()));
    };
    rates.push_back(over.frames_per_s());
    peak_rates.push_back(peaks.back().frames_per_s());
    ratios.push_back(against_the_peaks([](const auto& each) { return each.frames_per_s(); }));
    ratios_left.push_back(against_the_peaks(frames_per_s_left));
    std::printf(
        "peak %.1f, at ten times that %.1f, then %.1f: %.3f, %.3f of the time left\n%s\n",
        peak_rates[peak_rates.size() - 2], rates.back(), peak_rates.back(), ratios.back(),
        ratios_left.back(), load_document(over).dump().c_str());
    for (const auto& [status, count] : over.statuses) {
      EXPECT_TRUE(status == 200 || status == 429 || status == 503) << status << ": " << count;
    }
    EXPECT_EQ(over.truncated, 0u);
    EXPECT_EQ(over.without_retry_after, 0u);
    EXPECT_FALSE(over.reject_ms.empty());
    rejects.insert(rejects.end(), over.reject_ms.begin(), over.reject_ms.end());
    cpu_s += over.cpu_s;
    seconds += over.seconds;
  }
  std::printf(
      "%zu turned away in %.2f ms (half), %.2f ms (99 %%); %.1f frames a second at ten times "
      "the peak of %.1f, medians; their ratio is %.3f (median; %.3f to %.3f), of the time that "
      "the generator left %.3f (%.3f to %.3f); it took %.1f s of CPU in %.0f s\n",
      rejects.size(), quantile(rejects, 0.5), quantile(rejects, 0.99), quantile(rates, 0.5),
      quantile(peak_rates, 0.5), quantile(ratios, 0.5), quantile(ratios, 0),
      quantile(ratios, 1), quantile(ratios_left, 0.5), quantile(ratios_left, 0),
      quantile(ratios_left, 1), cpu_s, seconds);
  EXPECT_LT(quantile(rejects, 0.99), 10);
  EXPECT_GE(quantile(ratios_left, 0.5), 0.95);
}

TEST(Abuse, Overload) {
  overload(tiny_scene(), number_from_environment("CYANOMETER_ROUNDS", 7));
}

/// As people ask for: turning away ten times as many is nothing beside one of these.
TEST(Abuse, OverloadWithFramesOf720p) {
  overload({{"image", {{"width", 1280}, {"height", 720}}}},
           number_from_environment("CYANOMETER_LARGE_ROUNDS", 2));
}

/// Probes while something goes on; the worst times of 200.
std::vector<double> probe(const Served& served) {
  std::vector<double> times;
  for (int i = 0; i < 200; ++i) {
    const auto start = Clock::now();
    const auto answer = httplib::Client("127.0.0.1", served.ops_port).Get("/healthz");
    EXPECT_TRUE(answer && answer->status == 200);
    times.push_back(ms_since(start));
    std::this_thread::sleep_for(20ms);
  }
  return times;
}

TEST(Abuse, ConnectionsThatDoNothingOrLittle) {
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
  Served served;
  ASSERT_EQ(served.client().Post("/v1/render", tiny_scene().dump(), "application/json")->status,
            200);
  // 12 MB each: far more than the buffers between here and there hold.
  const std::string large =
      "GET /v1/render?image.width=1024&image.height=1024&image.format=npy&method.name=raymarch"
      "&method.view_nodes=1 HTTP/1.1\r\nHost: h\r\n\r\n";
  const auto begin = Clock::now();
  Crowd readers(served.port, 200, 4096);
  readers.send(large);
  Crowd drips(served.port, 1000), idle(served.port, 5000);
  std::atomic<bool> done = false;
  std::thread dripping([&] {
    for (int i = 0; !done; ++i) {
      drips.send(std::string(1, "GET /healthz HTTP/1.1\r\n"[i % 23]));
      std::this_thread::sleep_for(1s);
    }
  });
  const auto times = probe(served);
  std::printf("%zu slow readers, %zu dripping, %zu idle: probes p50 %.2f ms, worst %.2f ms\n",
              readers.size(), drips.size(), idle.size(), quantile(times, 0.5),
              quantile(times, 1));
  EXPECT_EQ(readers.size() + drips.size() + idle.size(), 6200u);
  EXPECT_LT(quantile(times, 1), 50);
  EXPECT_LT(ms_since(begin), 60000);
  done = true;
  dripping.join();
  readers.leave();
  drips.leave();
  idle.leave();
  const auto left = Clock::now();
  int status = 0;
  while (status != 200 && ms_since(left) < 10000) {
    const auto answer =
        served.client().Post("/v1/render", tiny_scene().dump(), "application/json");
    status = answer ? answer->status : 0;
  }
  std::printf("whole again %.0f ms after they left\n", ms_since(left));
  EXPECT_EQ(status, 200);
  EXPECT_LT(ms_since(left), 1000);
}

/// Frames that take seconds, by all methods and by a plan of a new planet.
json long_frame(std::size_t kind, int n) {
  const std::vector<json> methods{
      {{"name", "nishita"}, {"view_samples", 200}, {"light_samples", 100}},
      {{"name", "raymarch"}, {"view_nodes", 32}},
      {{"name", "path"}, {"samples_per_pixel", 64}},
      {{"name", "bruneton"}},
      {{"name", "moments"}, {"finer", 1}},
      {{"name", "hillaire"}, {"multiple_suns", 128}},
      {{"name", "auto"}, {"max_error", 0.001}}};
  return {{"method", methods[kind % methods.size()]},
          {"preset", n % 2 ? "mars" : "earth"},
          {"planet", {{"ground_albedo", 0.1 + 1e-4 * n}}},
          {"spectrum", {{"wavelengths_nm", {680, 600, 550, 500, 440, 400}}}},
          {"image", {{"width", 1920}, {"height", 1080}}}};
}

/// Spheres of many kinds, which take seconds to solve before anything is traced.
json long_optics(int n) {
  json constituents;
  for (int i = 0; i < 32; ++i) {
    constituents["cloud_" + std::to_string(i)] = {
        {"type", "particles"},
        {"visibility_km", 300},
        {"single_scattering_albedo", 0.9},
        {"profile", {{"type", "exponential"}, {"scale_height_km", 1}}},
        {"phase",
         {{"type", "mie"},
          {"radius_um", 20},
          {"geometric_sigma", 1.5},
          {"refractive_index", {1.33 + 1e-3 * i + 1e-5 * n, 1e-3}}}}};
  }
  for (const auto* name : {"air", "aerosol", "ozone"}) constituents[name] = nullptr;
  json wavelengths;
  for (int i = 0; i < 64; ++i) wavelengths.push_back(380 + 5 * i);
  return {{"atmosphere", {{"constituents", constituents}}},
          {"spectrum", {{"wavelengths_nm", wavelengths}}},
          {"image", {{"width", 64}, {"height", 36}}}};
}

struct LongWork {
  std::string name, path;
  json body;
};

/// Work that takes seconds, of all the kinds there are, each another one for another n.
std::vector<LongWork> long_works(int n) {
  std::vector<LongWork> works;
  for (std::size_t kind = 0; kind < 7; ++kind) {
    const json scene = long_frame(kind, n);
    works.push_back({scene["method"]["name"], "/v1/render", scene});
  }
  json directions;
  for (int i = 0; i < 4096; ++i) {
    directions.push_back({{"elevation_deg", 0.02 * i}, {"azimuth_deg", 0.08 * i}});
  }
  json walks = long_frame(2, n);
  walks["method"]["samples_per_pixel"] = 4096;
  works.push_back({"radiance", "/v1/radiance", {{"scene", walks}, {"directions", directions}}});
  works.push_back(
      {"compare", "/v1/compare", {{"a", long_frame(4, n)}, {"b", long_frame(2, n)}}});
  works.push_back({"explain", "/v1/explain", long_frame(6, n)});
  works.push_back({"chart", "/v1/chart", long_frame(6, n)});
  works.push_back({"stream", "/v1/stream", {{"scene", long_frame(2, n)}, {"refine", true}}});
  works.push_back({"optics", "/v1/optics", long_optics(n)});
  works.push_back({"plan of spheres", "/v1/plan", long_optics(n)});
  works.push_back({"frame of spheres", "/v1/render", long_optics(n)});
  works.back().body["method"] = {{"name", "raymarch"}};
  return works;
}

TEST(Abuse, ClientsThatLeave) {
  const int rounds = number_from_environment("CYANOMETER_LEAVERS", 6);
  Served served;
  // A kernel is compiled by its first dispatch, which no driver lets go of: here, or in a first
  // round that does not count.
  for (int n = 0; n < 14; ++n) {
    json scene = long_frame(static_cast<std::size_t>(n), n + 1000);
    scene["image"] = {{"width", 64}, {"height", 36}};
    const auto answer = served.client().Post("/v1/render", scene.dump(), "application/json");
    ASSERT_TRUE(answer && answer->status == 200) << scene;
  }
  std::mt19937 random(1);
  std::map<std::string, std::vector<double>> by_name;
  std::vector<double> times;
  double first = 0;
  // Nothing is left of it where the device has no job and its connection no thread.
  const auto open = [&] {
    return served.metric("cyanometer_device_busy") > 0 ||
           served.metric("cyanometer_connections") > 0;
  };
  for (int n = 0; n <= rounds; ++n) {
    for (const LongWork& work : long_works(n)) {
      const std::string body = work.body.dump();
      Crowd client(served.port, 1);
      client.send("POST " + work.path + " HTTP/1.1\r\nHost: h\r\nContent-Length: " +
                  std::to_string(body.size()) + "\r\n\r\n" + body);
      std::this_thread::sleep_for(std::chrono::milliseconds(300 + random() % 900));
      const bool device = work.name != "optics";
      if (device && served.metric("cyanometer_device_busy") < 1) continue;  // done, or between
      const auto left = Clock::now();
      client.leave();
      while (open() && ms_since(left) < 10000) std::this_thread::sleep_for(1ms);
      if (n == 0) {
        first = std::max(first, ms_since(left));
        continue;
      }
      times.push_back(ms_since(left));
      by_name[work.name].push_back(times.back());
    }
  }
  ASSERT_GT(by_name.size(), 12u);
  for (const auto& [name, each] : by_name) {
    std::printf("%-16s %6.0f ms (half) %6.0f ms (worst)\n", name.c_str(), quantile(each, 0.5),
                quantile(each, 1));
  }
  std::printf(
      "%zu clients left: nothing of their work was there after %.0f ms (half), %.0f ms (95 "
      "%%), "
      "%.0f ms (99 %%), %.0f ms (worst); where kernels were compiled first, %.0f ms at worst\n",
      times.size(), quantile(times, 0.5), quantile(times, 0.95), quantile(times, 0.99),
      quantile(times, 1), first);
  EXPECT_LT(quantile(times, 0.95), 100);
}

struct Asked {
  Clock::time_point sent = Clock::time_point::max();  ///< whole; never where nobody listens
  std::string answer = {};  ///< all that came, to the connection's end
};

Asked ask_once(int port, const std::string& request) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int one = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  Asked asked;
  if (::connect(one, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0) {
    (void)!::send(one, request.data(), request.size(), MSG_NOSIGNAL);
    asked.sent = Clock::now();
    char chunk[16384];
    for (ssize_t got; (got = ::recv(one, chunk, sizeof(chunk), 0)) > 0;) {
      asked.answer.append(chunk, static_cast<std::size_t>(got));
    }
  }
  ::close(one);
  return asked;
}

bool is_whole_answer(const std::string& answer) {
  const auto head = answer.find("\r\n\r\n");
  const auto length = answer.find("Content-Length: ");
  if (head == std::string::npos || length == std::string::npos || length > head) return false;
  return answer.size() == head + 4 + std::stoul(answer.substr(length + 16));
}

/// Who asks while it stops may find nobody there. Who had asked before is answered, whole.
TEST(Abuse, StoppedInTheMiddle) {
  const int stops = number_from_environment("CYANOMETER_STOPS", 50);
  std::mt19937 random(1);
  int whole = 0, frames = 0, none = 0, lost = 0, truncated = 0;
  for (int stop = 0; stop < stops; ++stop) {
    Served served;
    std::atomic<bool> done = false;
    std::atomic<int> i = 1000 * stop;
    std::vector<std::thread> clients;
    std::mutex mutex;
    std::vector<Clock::time_point> unanswered;  // when they were sent
    for (int c = 0; c < 8; ++c) {
      clients.emplace_back([&] {
        while (!done) {
          json scene{{"image", {{"width", 320}, {"height", 180}}}};
          scene["image"]["exposure_ev"] = 1e-6 * ++i;
          const std::string body = scene.dump();
          const auto [sent, answer] =
              ask_once(served.port,
                       "POST /v1/render HTTP/1.1\r\nHost: h\r\nConnection: close\r\n"
                       "Content-Length: " +
                           std::to_string(body.size()) + "\r\n\r\n" + body);
          const std::lock_guard lock(mutex);
          if (answer.empty()) {
            unanswered.push_back(sent);
            break;
          }
          (is_whole_answer(answer) ? whole : truncated) += 1;
          frames += answer.starts_with("HTTP/1.1 200");
        }
      });
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(300 + random() % 700));
    const auto stopped = Clock::now();
    served.run.signal(SIGTERM);
    EXPECT_EQ(served.run.wait(), 0);
    done = true;
    for (auto& each : clients) each.join();
    none += static_cast<int>(unanswered.size());
    // What was sent just before may not have been accepted yet.
    lost += static_cast<int>(std::ranges::count_if(
        unanswered, [&](const auto sent) { return sent < stopped - 200ms; }));
  }
  std::printf(
      "%d stops: %d whole answers, %d of them frames; %d truncated; %d unanswered, %d of them "
      "sent well before\n",
      stops, whole, frames, truncated, none, lost);
  EXPECT_EQ(truncated, 0);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(frames, stops);
}

/// The n-th of 70 forms of scene, kernels for which are alike in size: four absorbers of five
/// kinds of profile.
json scene_of_form(std::size_t n) {
  const std::vector<json> profiles{
      {{"type", "exponential"}, {"scale_height_km", 5}},
      {{"type", "tent"}, {"centre_km", 20}, {"half_width_km", 10}},
      {{"type", "quadratic"}},
      {{"type", "uniform"}},
      {{"type", "table"}, {"altitude_km", {0, 10, 50}}, {"density", {1, 0.5, 0.1}}}};
  std::vector<std::vector<std::size_t>> forms;
  for (std::size_t code = 0; code < 625; ++code) {
    const std::vector kinds{code % 5, code / 5 % 5, code / 25 % 5, code / 125};
    if (std::ranges::is_sorted(kinds)) forms.push_back(kinds);
  }
  json scene = tiny_scene();
  scene["method"] = {{"name", "nishita"}, {"view_samples", 8}, {"light_samples", 4}};
  scene["spectrum"] = {{"wavelengths_nm", {680, 550, 440}}};
  for (const std::size_t kind : forms.at(n)) {
    json& constituents = scene["atmosphere"]["constituents"];
    constituents["absorber_" + std::to_string(constituents.size())] = {
        {"type", "absorber"}, {"absorption_per_km", 1e-4}, {"profile", profiles[kind]}};
  }
  return scene;
}

TEST(Abuse, FormsOfScenesWithoutEnd) {
  Served served({"--kernels", "64", "--cache-mb", "16"});
  const auto meet = [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const auto answer =
          served.client().Post("/v1/render", scene_of_form(n).dump(), "application/json");
      ASSERT_TRUE(answer && answer->status == 200) << n;
      EXPECT_LE(served.metric("cyanometer_kernels"), 64);
    }
  };
  meet(0, 4);  // tables, and as many kernels as are kept
  const double resident = served.resident_mib();
  const double compiled = served.metric("cyanometer_kernels_compiled_total");
  meet(4, 14);
  std::printf("%.0f kernels compiled: resident %.1f MiB, %.0f: %.1f MiB\n", compiled, resident,
              served.metric("cyanometer_kernels_compiled_total"), served.resident_mib());
  EXPECT_GT(served.metric("cyanometer_kernels_compiled_total"), compiled + 128);
  EXPECT_NEAR(served.resident_mib(), resident, 0.1 * resident);
}

TEST(Abuse, Soak) {
  const double renders = number_from_environment("CYANOMETER_RENDERS", 100000);
  Served served(
      {"--cache-mb", "16"});  // full of frames after a tenth: what it keeps grows no more
  LoadSettings settings;
  settings.origin = served.origin();
  settings.clients = 4;
  settings.seconds = 5;
  settings.scene = {{"image", {{"width", 16}, {"height", 9}}},
                    {"method", {{"name", "raymarch"}, {"view_nodes", 2}}}};
  settings.scene["spectrum"] = {{"wavelengths_nm", {680, 550, 440}}};
  const std::string count = "cyanometer_frames_rendered_total";
  while (served.metric(count) < 0.1 * renders) load(settings);
  std::this_thread::sleep_for(1s);  // the last frames are encoded, their connections closed
  const double resident = served.resident_mib();
  const double device = served.metric("cyanometer_device_memory_bytes");
  const auto files = served.open_files();
  while (served.metric(count) < renders) load(settings);
  std::this_thread::sleep_for(1s);
  std::printf(
      "%.0f renders: resident %.1f MiB after a tenth, %.1f at the end; device memory "
      "%.0f and %.0f bytes; open files %zu and %zu\n",
      served.metric(count), resident, served.resident_mib(), device,
      served.metric("cyanometer_device_memory_bytes"), files, served.open_files());
  EXPECT_NEAR(served.resident_mib(), resident, 0.02 * resident);
  EXPECT_EQ(served.metric("cyanometer_device_memory_bytes"), device);
  EXPECT_EQ(served.open_files(), files);
}

}  // namespace
}  // namespace cyanometer::testing
