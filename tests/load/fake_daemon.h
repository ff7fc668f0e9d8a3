// A daemon that answers at once what a test wants.
#pragma once

#include <httplib.h>

#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace cyanometer::testing {

class FakeDaemon {
 public:
  FakeDaemon();
  ~FakeDaemon();

  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  /// The scenes asked for so far.
  std::vector<nlohmann::json> scenes() const;

  // To be set before anything is asked.
  std::string metrics;          ///< none: there are none
  double cpu_s_a_frame = 0;     ///< told as process_cpu_seconds_total where it is not 0
  std::string token;            ///< asked of everything but readyz
  std::size_t fail_after = -1;  ///< frames, beyond which it says 503
  double error = 0.01;          ///< that frames state, and a hundredth more each

  std::atomic<std::size_t> frames{0}, judged{0};

 private:
  void render(const httplib::Request& request, httplib::Response& answer);
  bool refused(const httplib::Request& request, httplib::Response& answer) const;

  httplib::Server server_;
  int port_;
  mutable std::mutex mutex_;
  std::vector<nlohmann::json> scenes_;
  std::thread thread_;
};

}  // namespace cyanometer::testing
