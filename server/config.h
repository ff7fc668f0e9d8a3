// The daemon's configuration: one struct, and one list from which flags, environment, --help
// and the README's table come.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct Config {
  std::string listen = "127.0.0.1:8080";
  std::string ops_listen;
  std::string device;
  int threads = 512;
  int queue = 64;
  double deadline_s = 600;
  double drain_s = 0;
  int max_pixels = 4096 * 4096;
  int max_wavelengths = 64;
  double max_samples = 16777216;
  double max_device_s = 3600;
  int max_frames = 3600;
  double max_body_mb = 64;
  double frame_memory_mb = 2048;
  double cache_mb = 256;
  int kernels = 192;
  std::string surfaces;
  std::string trusted_proxy;
  std::string token;
  std::string cors_origin;
  std::string log_level = "info";

  // No settings: for tests.
  bool warm = true;
  EngineFaults faults = {};

  std::size_t body_bytes() const { return static_cast<std::size_t>(max_body_mb * 1048576); }
  /// Of what is kept between requests, frames get a quarter, the images of surfaces an eighth,
  /// and tables (with those images on the device) the rest.
  std::size_t kept_frame_bytes() const { return static_cast<std::size_t>(cache_mb * 262144); }
  std::size_t surface_bytes() const { return kept_frame_bytes() / 2; }
  std::size_t table_bytes() const {
    return 4 * kept_frame_bytes() - kept_frame_bytes() -
           (surfaces.empty() ? 0 : surface_bytes());
  }
  std::size_t frame_bytes() const {
    return static_cast<std::size_t>(frame_memory_mb * 1048576);
  }
};

struct Setting {
  std::string
      name;  ///< "ops-listen": the flag is --ops-listen, the variable CYANOMETER_OPS_LISTEN
  std::string help;
  std::variant<std::string Config::*, int Config::*, double Config::*> member;
  double minimum = 0, maximum = 0;        ///< of numbers
  std::vector<std::string> choices = {};  ///< of strings; empty: any

  std::string flag() const { return "--" + name; }
  std::string variable() const;
};
const std::vector<Setting>& settings();

/// The README's table: flag, variable, default, meaning.
std::string settings_markdown();

}  // namespace cyanometer
