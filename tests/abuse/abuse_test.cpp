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
#include <sstream>

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
  /// What it took of the processors until now.
  double cpu_s() const {
    std::ifstream in("/proc/" + std::to_string(run.pid()) + "/stat");
    std::string text(std::istreambuf_iterator<char>(in), {});
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
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

/// A run of the load generator, and what it took of the daemon.
struct Run {
  LoadReport load;
  double daemon_cpu_s;

  double frames_per_s() const { return load.frames_per_s(); }
  /// All of them: those too that came after the time.
  double frames() const { return static_cast<double>(load.frame_ms.size()); }
};

/// Other scenes each time, so that none has been kept.
Run run_next(const Served& served, LoadSettings& settings) {
  const double before = served.cpu_s();
  Run made{run_load(settings), 0};
  made.daemon_cpu_s = served.cpu_s() - before;
  settings.first += made.load.sent();
  return made;
}

/// What turning away one request takes of the daemon, ms, where a frame takes what it took at
/// the peak.
double reject_cpu_ms(const Run& peak, const Run& over) {
  const double frames = over.frames() * peak.daemon_cpu_s / peak.frames();
  return 1000 * (over.daemon_cpu_s - frames) / static_cast<double>(over.load.reject_ms.size());
}

/// The share of the processors that the generator took.
double generator_share(const Run& run) {
  const double cores = std::thread::hardware_concurrency();
  return run.load.cpu_s / (run.load.seconds * cores);
}

/// The law: at ten times what it can do the daemon makes 95 % of the frames that it makes at
/// its peak, at least, and turns the others away at once. The generator works on the same
/// processors; what is made of the time that it leaves is printed beside. Peak and overload are
/// measured in turn, so that what else goes on here meets both: each overload is held against
/// the peaks before and after it.
void overload(const json& scene, int rounds) {
  Served served;
  LoadSettings settings;
  settings.origin = served.origin();
  settings.scene = scene;
  // One of three clients asks for most: it is told that its share is used up (429), and all
  // where no place is left (503).
  settings.sources = {"127.0.0.1", "127.0.0.1", "127.0.0.1", "127.0.0.2", "127.0.0.3"};
  const auto closed = [&](int clients) {
    settings.clients = clients;
    settings.rate.reset();
    settings.seconds = 10;
    return run_next(served, settings);
  };
  const auto open = [&](double rate) {
    settings.clients = 300;
    settings.rate = rate;
    settings.seconds = 20;
    return run_next(served, settings);
  };
  closed(16);  // plans, pipelines, the pacer
  const int clients = closed(16).frames_per_s() > closed(40).frames_per_s() ? 16 : 40;
  std::vector<double> ratios, raw_ratios, times, rejects, cpu_ms, generator;
  std::map<int, std::size_t> statuses;
  std::size_t late = 0, sent = 0;
  Run before = closed(clients);
  for (int round = 0; round < rounds; ++round) {
    const Run over = open(10 * before.frames_per_s());
    const Run after = closed(clients);
    const LoadReport& load = over.load;
    raw_ratios.push_back(2 * over.frames_per_s() /
                         (before.frames_per_s() + after.frames_per_s()));
    generator.push_back(generator_share(over) - generator_share(before));
    ratios.push_back(raw_ratios.back() / (1 - generator.back()));
    times.push_back(load.asked_per_s() / before.frames_per_s());
    cpu_ms.push_back(reject_cpu_ms(before, over));
    rejects.insert(rejects.end(), load.reject_ms.begin(), load.reject_ms.end());
    for (const auto& [status, count] : load.statuses) statuses[status] += count;
    late += load.late;
    sent += load.sent();
    EXPECT_EQ(load.truncated, 0u);
    EXPECT_EQ(load.without_retry_after, 0u);
    std::printf(
        "%d clients %.1f frames a second, %.2f times as many asked for %.1f, then %.1f: "
        "%.3f, of what the generator left %.3f\n%s\n",
        clients, before.frames_per_s(), times.back(), over.frames_per_s(), after.frames_per_s(),
        raw_ratios.back(), ratios.back(), load_document(load).dump().c_str());
    before = after;
  }
  std::printf(
      "%zu turned away in %.2f ms (half), %.2f ms (99 %%), each for %.0f us of the daemon's "
      "CPU; "
      "asked %.1f times the peak it makes %.3f of its frames, %.3f (%.3f to %.3f) of those in "
      "the time that the generator left, which took %.0f %% more of the processors and was "
      "late "
      "with %.1f %% (medians)\n",
      rejects.size(), quantile(rejects, 0.5), quantile(rejects, 0.99),
      1000 * quantile(cpu_ms, 0.5), quantile(times, 0.5), quantile(raw_ratios, 0.5),
      quantile(ratios, 0.5), quantile(ratios, 0), quantile(ratios, 1),
      100 * quantile(generator, 0.5),
      100 * static_cast<double>(late) / static_cast<double>(sent));
  for (const auto& [status, count] : statuses) {
    EXPECT_TRUE(status == 200 || status == 429 || status == 503) << status << ": " << count;
  }
  EXPECT_GT(statuses[429], 0u);
  EXPECT_GT(statuses[503], 0u);
  EXPECT_GT(quantile(times, 0), 9.5) << "or it was no overload of ten times";
  EXPECT_LT(static_cast<double>(late), 0.05 * static_cast<double>(sent));
  EXPECT_LT(quantile(rejects, 0.99), 10);
  EXPECT_GE(quantile(raw_ratios, 0.5), 0.95);
}

TEST(Abuse, OverloadWithSmallFrames) {
  overload(tiny_scene(), number_from_environment("CYANOMETER_ROUNDS", 7));
}

/// As people ask for: turning away ten times as many is nothing beside one of these.
TEST(Abuse, OverloadWithFramesOf720p) {
  overload({{"image", {{"width", 1280}, {"height", 720}}}},
           number_from_environment("CYANOMETER_LARGE_ROUNDS", 5));
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

/// A frame that nobody has asked for.
int status_of_fresh_frame(const Served& served) {
  static int number = 0;
  json scene = tiny_scene();
  scene["image"]["exposure_ev"] = 0.5 + 1e-6 * ++number;
  const auto answer = served.client().Post("/v1/render", scene.dump(), "application/json");
  return answer ? answer->status : 0;
}

void allow_all_files() {
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

template <class Done>
void wait_until(const Done& done, std::chrono::seconds patience) {
  const auto start = Clock::now();
  while (!done() && Clock::now() - start < patience) std::this_thread::sleep_for(10ms);
}

TEST(Abuse, ConnectionsThatDoNothingOrLittle) {
  allow_all_files();
  Served served({"--queue", "400"});  // of which one client has three quarters
  ASSERT_EQ(status_of_fresh_frame(served), 200);
  const auto connections = [&] { return served.metric("cyanometer_connections"); };
  // 3 MB each, and each another frame: more than the buffers between here and there hold.
  Crowd readers(served.port, 200, 4096);
  readers.send_each([](std::size_t n) {
    return "GET "
           "/v1/render?image.width=500&image.height=500&image.format=npy&method.name=raymarch"
           "&method.view_nodes=1&spectrum.wavelengths_nm=%5B680,550,440%5D&sun.elevation_deg=" +
           std::to_string(0.3 * static_cast<double>(n)) + " HTTP/1.1\r\nHost: h\r\n\r\n";
  });
  for (int i = 0; i < 120 && readers.being_answered(200) < 200; ++i) {
    std::this_thread::sleep_for(1s);
    readers.sip();
  }
  const auto begin = Clock::now();
  Crowd drips(served.port, 1000), idle(served.port, 5000);
  EXPECT_EQ(readers.size() + drips.size() + idle.size(), 6200u);
  wait_until([&] { return connections() == 512; }, 5s);
  EXPECT_GE(connections(), 500) << "nearly as many as there are threads";
  std::atomic<bool> done = false;
  std::thread trickle([&] {
    for (int i = 0; !done; ++i) {
      drips.send(std::string(1, "GET /healthz HTTP/1.1\r\n"[i % 23]));
      readers.sip();
      std::this_thread::sleep_for(1s);
    }
  });
  const auto times = probe(served);
  done = true;
  trickle.join();
  std::printf("%zu slow readers, %zu dripping, %zu idle: probes p50 %.2f ms, worst %.2f ms\n",
              readers.being_answered(200), drips.size(), idle.size(), quantile(times, 0.5),
              quantile(times, 1));
  EXPECT_EQ(readers.being_answered(200), 200u) << "who reads is not hung up on";
  EXPECT_GE(connections(), 200) << "nor done with";
  EXPECT_LT(quantile(times, 1), 50);
  EXPECT_LT(ms_since(begin), 60000);
  readers.leave();
  drips.leave();
  idle.leave();
  const auto left = Clock::now();
  EXPECT_EQ(status_of_fresh_frame(served), 200);
  wait_until([&] { return connections() == 0; }, 10s);
  std::printf("whole again %.0f ms after they left\n", ms_since(left));
  EXPECT_LT(ms_since(left), 1000);
}

TEST(Abuse, HundredsOfHalfSentBodies) {
  allow_all_files();
  Served served;
  const std::string half =
      "POST /v1/render HTTP/1.1\r\nHost: h\r\nContent-Length: 9000\r\n\r\n{";
  std::vector<std::unique_ptr<Crowd>> crowds;
  std::vector<double> times;
  for (int i = 0; i < 30; ++i) {
    crowds.push_back(std::make_unique<Crowd>(served.port, i == 0 ? 600 : 50));
    crowds.back()->send(half);
    const auto start = Clock::now();
    EXPECT_EQ(status_of_fresh_frame(served), 200) << i;
    times.push_back(ms_since(start));
  }
  std::printf("frames among half-sent bodies: %.0f ms (half), %.0f ms at worst\n",
              quantile(times, 0.5), quantile(times, 1));
  EXPECT_GE(served.metric("cyanometer_connections"), 500) << "they are there";
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
  // A kernel is compiled by its first dispatch, which no driver lets go of: most are here, and
  // work that has met others is told apart.
  for (int n = 0; n < 14; ++n) {
    json scene = long_frame(static_cast<std::size_t>(n), n + 1000);
    scene["image"] = {{"width", 64}, {"height", 36}};
    const auto answer = served.client().Post("/v1/render", scene.dump(), "application/json");
    ASSERT_TRUE(answer && answer->status == 200) << scene;
  }
  std::mt19937 random(1);
  std::map<std::string, std::vector<double>> by_name;
  std::vector<double> times, compiling;
  const auto kernels = [&] { return served.metric("cyanometer_kernels_compiled_total"); };
  // Nothing is left of it where the device has no job and its connection no thread.
  const auto open = [&] {
    return served.metric("cyanometer_device_busy") > 0 ||
           served.metric("cyanometer_connections") > 0;
  };
  for (int n = 0; n <= rounds; ++n) {
    for (const LongWork& work : long_works(n)) {
      const std::string body = work.body.dump();
      const double kernels_before = kernels();
      Crowd client(served.port, 1);
      client.send("POST " + work.path + " HTTP/1.1\r\nHost: h\r\nContent-Length: " +
                  std::to_string(body.size()) + "\r\n\r\n" + body);
      std::this_thread::sleep_for(std::chrono::milliseconds(300 + random() % 900));
      const bool device = work.name != "optics";
      if (device && served.metric("cyanometer_device_busy") < 1) continue;  // done, or between
      const auto left = Clock::now();
      client.leave();
      while (open() && ms_since(left) < 10000) std::this_thread::sleep_for(1ms);
      const double took = ms_since(left);
      if (kernels() > kernels_before) {
        compiling.push_back(took);
      } else {
        times.push_back(took);
        by_name[work.name].push_back(took);
      }
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
      "%.0f ms (99 %%), %.0f ms (worst); where kernels were met for the first time (%zu), %.0f "
      "ms "
      "at worst\n",
      times.size(), quantile(times, 0.5), quantile(times, 0.95), quantile(times, 0.99),
      quantile(times, 1), compiling.size(), quantile(compiling, 1));
  EXPECT_LT(quantile(times, 1), 100);
  EXPECT_LT(quantile(compiling, 1), 1000);
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
  if (answer.find("\r\nContent-Type: multipart/") < head)
    return answer.ends_with("--frame--\r\n");
  const auto length = answer.find("Content-Length: ");
  if (head == std::string::npos || length == std::string::npos || length > head) return false;
  return answer.size() == head + 4 + std::stoul(answer.substr(length + 16));
}

/// What the n-th of several clients asks for the i-th time: streams, large frames and small
/// ones.
std::string request_of(int client, int i) {
  json scene{{"image", {{"width", 320}, {"height", 180}, {"exposure_ev", 1e-6 * i}}}};
  if (client == 1) scene["image"].update({{"width", 1280}, {"height", 720}});
  const json sweep{{"scene", scene}, {"frames", 4}, {"to", {{"sun.elevation_deg", 10}}}};
  const std::string body = client == 0 ? sweep.dump() : scene.dump();
  return std::string("POST /v1/") + (client == 0 ? "stream" : "render") +
         " HTTP/1.1\r\nHost: h\r\nConnection: close\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
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
      clients.emplace_back([&, c] {
        while (!done) {
          const auto [sent, answer] = ask_once(served.port, request_of(c, ++i));
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

/// Frames of several atmospheres, suns, methods and files, none like another; but plans,
/// kernels and tables of all of them are met long before a tenth of the renders, and kept.
json varied_scene(std::size_t n) {
  static const std::vector<json> methods{
      {{"name", "raymarch"}, {"view_nodes", 2}},
      {{"name", "nishita"}, {"view_samples", 8}, {"light_samples", 4}},
      {{"name", "hillaire"}, {"march_pixels", 1}},
      {{"name", "path"}, {"samples_per_pixel", 1}}};
  static const std::vector<std::string> presets{"earth", "mars", "earth_hazy"};
  static const std::vector<std::string> formats{"png", "jpeg", "exr", "hdr", "npy"};
  static const std::vector<double> suns_deg{-4, 3, 20, 60};
  const double sun_deg = suns_deg[n / 60 % suns_deg.size()] + 1e-7 * static_cast<double>(n);
  return {{"preset", presets[n % presets.size()]},
          {"method", methods[n % methods.size()]},
          {"sun", {{"elevation_deg", sun_deg}}},
          {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
          {"image", {{"width", 16}, {"height", 9}, {"format", formats[n % formats.size()]}}}};
}

TEST(Abuse, Soak) {
  const double renders = number_from_environment("CYANOMETER_RENDERS", 100000);
  Served served(
      {"--cache-mb", "16"});  // full of frames after a tenth: what it keeps grows no more
  LoadSettings settings;
  settings.origin = served.origin();
  settings.clients = 4;
  settings.seconds = 5;
  settings.scenes = varied_scene;
  const std::string count = "cyanometer_frames_rendered_total";
  const auto render_until = [&](double renders_in_all) {
    while (served.metric(count) < renders_in_all) {
      for (const auto& [status, answers] : run_next(served, settings).load.statuses) {
        EXPECT_EQ(status, 200) << answers;
      }
    }
    std::this_thread::sleep_for(1s);  // the last frames are encoded, their connections closed
  };
  render_until(0.1 * renders);
  const double resident = served.resident_mib();
  const double device = served.metric("cyanometer_device_memory_bytes");
  const double kernels = served.metric("cyanometer_kernels_compiled_total");
  const auto files = served.open_files();
  render_until(renders);
  std::printf(
      "%.0f renders: resident %.1f MiB after a tenth, %.1f at the end; device memory %.0f and "
      "%.0f bytes; open files %zu and %zu; %.0f kernels\n",
      served.metric(count), resident, served.resident_mib(), device,
      served.metric("cyanometer_device_memory_bytes"), files, served.open_files(), kernels);
  EXPECT_NEAR(served.resident_mib(), resident, 0.02 * resident);
  EXPECT_EQ(served.metric("cyanometer_device_memory_bytes"), device);
  EXPECT_EQ(served.open_files(), files);
  EXPECT_EQ(served.metric("cyanometer_kernels_compiled_total"), kernels);
}

}  // namespace
}  // namespace cyanometer::testing
