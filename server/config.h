// The daemon's configuration: one struct, and one list from which flags, environment, --help
// and the README's table come.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

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
  double max_body_mb = 4;
  double frame_memory_mb = 2048;
  double cache_mb = 256;
  std::string log_level = "info";

  std::size_t body_bytes() const { return static_cast<std::size_t>(max_body_mb * 1048576); }
  std::size_t cache_bytes() const { return static_cast<std::size_t>(cache_mb * 1048576); }
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
