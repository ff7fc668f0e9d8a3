#include "server/config.h"

#include <cmath>
#include <sstream>

namespace cyanometer {
namespace {

std::string default_text(const Setting& setting) {
  const Config defaults;
  std::ostringstream out;
  out.precision(12);
  std::visit([&](auto member) { out << defaults.*member; }, setting.member);
  return out.str();
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> list{
      {"listen", "address to serve on; port 0 takes a free one", &Config::listen},
      {"ops-listen", "address for healthz, readyz and metrics alone, on threads of their own",
       &Config::ops_listen},
      {"device", "part of the Vulkan device's name; empty takes the best", &Config::device},
      {"threads",
       "connections at once, each with a cheap thread; where all are being answered, more are "
       "refused with 503",
       &Config::threads, 1, 900},
      {"queue", "requests that may wait for the device; more are refused with 503",
       &Config::queue, 1, 100000},
      {"deadline-s", "seconds after which a request is given up with 504", &Config::deadline_s,
       0.001, 86400},
      {"drain-s", "seconds between not being ready and no longer listening, on SIGTERM",
       &Config::drain_s, 0, 3600},
      {"max-pixels", "pixels of one frame; over it 422", &Config::max_pixels, 1, 1e9},
      {"max-wavelengths", "wavelengths of one request; over it 422", &Config::max_wavelengths,
       1, 64},
      {"max-samples",
       "samples of a pixel: paths, or view samples times light samples; over it 422",
       &Config::max_samples, 1, 1e12},
      {"max-device-s",
       "seconds that a frame may be expected to take on the device; over it 422",
       &Config::max_device_s, 0.001, 1e9},
      {"max-frames", "frames of one stream; over it 422", &Config::max_frames, 1, 1000000},
      {"max-body-mb", "MiB of a request's body; over it 413", &Config::max_body_mb, 0.001,
       1024},
      {"frame-memory-mb",
       "MiB of all frames alive at once; one that needs more by itself is refused with 422",
       &Config::frame_memory_mb, 1, 1e6},
      {"cache-mb",
       "MiB of all tables, frames and maps kept between requests; the map used last stays "
       "besides",
       &Config::cache_mb, 0, 1e6},
      {"kernels",
       "compiled kernels kept, one for each form of scene that each step of a method met, of "
       "some 5 MiB on a processor; the least recently used goes first",
       &Config::kernels, 32, 100000},
      {"surfaces", "folder of images that scenes may name in planet.surface; empty: none may",
       &Config::surfaces},
      {"trusted-proxy",
       "addresses and networks, as 127.0.0.1,10.0.0.0/8, of proxies whose X-Forwarded-For says "
       "who the client is; empty: who connects",
       &Config::trusted_proxy},
      {"token",
       "secret that requests bring as `Authorization: Bearer ...`, but for healthz and readyz; "
       "empty asks for none (better set in the environment, where process lists do not show "
       "it)",
       &Config::token},
      {"cors-origin",
       "origin whose pages may read answers, as https://example.org, or *; empty allows none",
       &Config::cors_origin},
      {"log-level",
       "debug logs probes too, warning only what went wrong",
       &Config::log_level,
       0,
       0,
       {"debug", "info", "warning", "error"}},
  };
  return list;
}

std::string Setting::variable() const {
  std::string out = "CYANOMETER_";
  for (const char c : name) {
    out += c == '-' ? '_' : static_cast<char>(c >= 'a' && c <= 'z' ? c - ('a' - 'A') : c);
  }
  return out;
}

std::string settings_markdown() {
  std::string out = "| flag | environment | default | meaning |\n|---|---|---|---|\n";
  for (const auto& setting : settings()) {
    const auto text = default_text(setting);
    out += "| `" + setting.flag() + "` | `" + setting.variable() + "` | " +
           (text.empty() ? "" : "`" + text + "`") + " | " + setting.help + " |\n";
  }
  return out;
}

}  // namespace cyanometer
