// How many frames a second a daemon makes of each class of frames, beside the least that such a
// frame could take, and how wrong they are.
#pragma once

#include <sys/types.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "server/load/floor.h"

namespace cyanometer {

/// One load: so many clients, each with one request at once, for frames of one class.
struct SurveyPoint {
  int width = 0, height = 0;
  std::string format, vary;  ///< as `image.format`, and as variation_names()
  int clients = 0;
  double frames_per_s = 0, p50_ms = 0, p99_ms = 0;
  double cpu_s = 0, generator_cpu_s = 0;  ///< a frame, of the daemon and of who asks
  double stated_error = 0;                ///< the largest that a frame said
  std::vector<std::string> methods = {};  ///< with their options
  std::size_t failed = 0, truncated = 0;  ///< answers other than 200; images without an end
  Floor floor = {};                       ///< measured just before

  /// The least time of a frame of this class: pixels stored and a picture encoded, one after
  /// the other; of a frame that does not change, an answer without any.
  double floor_ms() const {
    return vary == "nothing" ? floor.answer_ms : floor.store_ms + floor.encode_ms;
  }
  /// The time from one frame to the next over the floor; 0 where no frame came.
  double over_floor() const;
};

/// The error of one frame of a class against its converged solution.
struct SurveyError {
  std::string preset;  ///< "" of the scene that was timed
  std::string vary;
  int width = 0, height = 0;
  std::string method = {};  ///< with its options
  double stated = 0;        ///< what the frame said: a bound that is to hold in 95 % of frames
  double error = 0, low = 0, high = 0;  ///< measured, with its 95 % interval

  /// The error or, where the reference's noise hides it, the most that it may be.
  double told() const { return error > 0 ? error : high; }
};

struct Survey {
  std::string device, version;
  std::vector<SurveyPoint> points;
  std::vector<SurveyError> errors;
};

struct SurveySettings {
  nlohmann::json scene =
      nlohmann::json::object();  ///< that is timed; its image does not matter
  double seconds = 3;            ///< of each load, after a quarter as much
  std::vector<int> clients{1, 4, 16, 64};
  std::vector<std::pair<int, int>> sizes{{640, 360}, {1280, 720}, {1920, 1080}};
  std::vector<std::string> formats{"png", "jpeg", "exr"};
  std::vector<std::string> vary{"camera", "sun", "atmosphere", "everything", "nothing"};
  std::vector<std::string> presets{
      "earth_noon", "earth_low_sun", "earth_sunset", "earth_twilight", "earth_hazy",
      "earth_10km", "earth_limb",    "mars",         "titan",          "earth_us76"};
};

/// Where it is measured.
struct SurveyedDaemon {
  std::string origin;
  pid_t process = 0;
  /// Of its device: Engine::store_ms.
  std::function<double(const Image&)> store_ms;
};

/// What is to be measured and is not in the survey, without figures; fewest clients first.
std::vector<SurveyPoint> missing_points(const SurveySettings& settings, const Survey& survey);
/// Of one frame of each way to vary, at each size, of the scene and of each preset by the
/// scene's choice of method.
std::vector<SurveyError> missing_errors(const SurveySettings& settings, const Survey& survey);

/// Adds the missing points, and calls `done` after each.
/// @throws Cancelled between two points, std::runtime_error where the daemon has gone
void measure_rates(const SurveyedDaemon& daemon, const SurveySettings& settings,
                   const Watch& watch, const std::function<void(const SurveyPoint&)>& done,
                   Survey& survey);
/// Adds the missing errors. Of frames of two sizes by equal methods and options the first is
/// measured for both. @throws as measure_rates
void measure_errors(const SurveyedDaemon& daemon, const SurveySettings& settings,
                    const Watch& watch, const std::function<void(const SurveyError&)>& done,
                    Survey& survey);

std::string survey_table(const Survey& survey, const SurveySettings& settings);
std::string survey_svg(const Survey& survey);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SurveyPoint, width, height, format, vary, clients,
                                   frames_per_s, p50_ms, p99_ms, cpu_s, generator_cpu_s,
                                   stated_error, methods, failed, truncated, floor)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SurveyError, preset, vary, width, height, method, stated,
                                   error, low, high)

}  // namespace cyanometer
