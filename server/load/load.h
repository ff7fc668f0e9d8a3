// Load on a daemon, and what came of it.
#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/load/variation.h"

namespace cyanometer {

/// The n-th scene that is asked for.
using Scenes = std::function<nlohmann::json(std::size_t n)>;

struct LoadSettings {
  std::string origin = "http://127.0.0.1:8080";
  int clients = 8;  ///< connections, each with one request at a time
  /// Requests a second that arrive at random, whether or not earlier ones have been answered
  /// (an open load); none: each client asks again as soon as it has its answer (a closed one).
  std::optional<double> rate;
  double seconds = 10;  ///< what is asked for is answered to the end, but counts until then
  nlohmann::json scene = nlohmann::json::object();
  Variation vary = Variation::exposure;
  Scenes scenes = {};  ///< in place of these two
  /// Addresses of this machine from which the clients ask, in turn; none: as the system
  /// chooses.
  std::vector<std::string> sources = {};
  std::size_t first = 0;  ///< number of the first frame: another one, another run
  std::string get;        ///< asks for this path instead of frames
  std::string token;
  pid_t daemon =
      0;  ///< its process, where it is one of this machine; 0: /metrics says its time
};

struct LoadReport {
  std::map<int, std::size_t> statuses;  ///< of all; 0: no answer
  std::vector<double> frame_ms;         ///< of answers 200, from when the request was due
  std::vector<double> reject_ms;        ///< of answers 429 and 503, from when it was sent
  std::size_t without_retry_after = 0;  ///< of those
  std::size_t truncated = 0;            ///< answers 200 that are images without an end
  std::size_t kept = 0;                 ///< answers 200 that no work was done for
  std::size_t unmet = 0;                ///< answers 200 that say to be worse than was asked
  std::size_t late = 0;                 ///< sent over 10 ms after they were due
  std::size_t asked = 0;                ///< requests sent in the time
  std::size_t frames = 0;               ///< answers 200 that were there in the time
  double seconds = 0;                   ///< the time
  double cpu_s = 0;                     ///< of the generator itself, to the last answer
  std::optional<double> daemon_cpu_s;   ///< where it is known
  /// What frames say of themselves: the largest error, and all methods with their options.
  double stated_error = 0;
  std::set<std::string> methods;
  std::map<std::string, std::vector<double>> stage_ms;  ///< "queue", "prepare", ...

  double asked_per_s() const;
  double frames_per_s() const;
  std::size_t sent() const;
};

/// The clock starts when all clients have connected.
/// @throws std::runtime_error where nobody answers at the origin
LoadReport run_load(const LoadSettings& settings);

/// The value below which that share of them lies; 0 of none.
double quantile(std::vector<double> values, double share);

nlohmann::json load_document(const LoadReport& report);

}  // namespace cyanometer
