// Speed against accuracy: every method over a grid of its settings on some scenes, each point
// with the time of a frame, that of its tables, its memory and its error against a reference.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/accuracy/error.h"
#include "engine/accuracy/reference.h"
#include "engine/engine.h"

namespace cyanometer {

struct ChartPoint {
  std::string method;
  std::map<std::string, double> options;
  EstimatedError error;
  /// Of frames whose tables are there: the median and the spread, ms.
  double frame_ms = 0, fastest_ms = 0, slowest_ms = 0;
  double tables_ms = 0, tables_mib = 0;
  std::string failure;  ///< why there are no figures

  /// The cost of one of `frames` frames that share an atmosphere, ms.
  double cost_ms(double frames) const { return frame_ms + tables_ms / frames; }
};

struct ChartScene {
  std::string name;
  nlohmann::json document;  ///< canonical
  std::int64_t walks = 0;   ///< of each half of the reference
  double noise = 0;         ///< of the reference
  std::vector<ChartPoint> points;
  nlohmann::json goal = {};  ///< of the reference that the points are held against
};

struct Chart {
  std::string device, version;
  std::vector<ChartScene> scenes;
};

struct ChartSettings {
  ReferenceGoal reference;
  std::filesystem::path references;  ///< where they are kept
  int pixels = 320 * 180;            ///< of the frames that are timed
  double longest_ms =
      1e4;  ///< a method's settings beyond one whose frame takes longer are left out
  std::vector<std::string> methods;  ///< none: all
  bool defaults_only = false;        ///< each method once, as it is where nothing is asked
  /// Tables that others share stay: what making them takes is told of those alone that are not
  /// there yet.
  bool keep_tables = false;
};

/// The scene as it is charted: at three wavelengths where it leaves them open, since otherwise
/// methods would be compared by how many they are given; and about so many pixels large.
Scene charted(const Scene& scene, int pixels);

/// Every option of the method as it is where nothing is asked.
std::map<std::string, double> defaults_of(const MethodDescription& method);

/// The settings at which a method is charted, roughly cheapest first.
std::vector<std::map<std::string, double>> chart_settings(const MethodDescription& method);

/// One point, its error in the contract's channels. @param scene as it is charted, and as it
/// was for the reference
/// @throws Cancelled, DeviceLost
ChartPoint measure_point(Engine& engine, const Scene& scene, const Reference& reference,
                         const std::string& method,
                         const std::map<std::string, double>& options,
                         const ChartSettings& settings, const Watch& watch);

/// Adds the points that `scene` lacks, and calls `done` after each; those that were measured
/// towards another goal go. @param scene has its document
void measure_points(Engine& engine, const ChartSettings& settings, const Watch& watch,
                    const std::function<void(const ChartPoint&)>& done, ChartScene& scene);

/// The error that a point is ranked and drawn by. Below the reference's noise nobody can tell
/// one from another, and none at all is chance: then the upper end of what it may be counts.
double told_error(const ChartScene& scene, const ChartPoint& point);

/// The points that no other beats both in error and in cost at so many frames an atmosphere,
/// fastest first; places in `scene.points`.
std::vector<std::size_t> pareto_front(const ChartScene& scene, double frames);

/// Takes over what an earlier chart of the same version and device has: the points of the same
/// scenes, and the scenes that have none of the names in `chart`, which come first.
void take_over(const Chart& before, Chart& chart);

nlohmann::json point_document(const ChartPoint& point);
nlohmann::json chart_document(const Chart& chart);
/// What chart_document wrote. @throws nlohmann::json::exception
Chart chart_from(const nlohmann::json& document);
std::string chart_csv(const Chart& chart);

}  // namespace cyanometer
