// A row of the stability suite: scenes that are known to break methods, what is measured on
// them, and how large it may be.
#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "engine/stability/trial.h"

namespace cyanometer {

constexpr double degree = std::numbers::pi / 180;  ///< in radians

struct StabilityRow {
  int number = 0;
  std::string name;
  std::string trigger;   ///< what the sweep is over, with its unit
  std::string quantity;  ///< what is measured
  double bound = 0;      ///< of the quantity; fixed before anything was measured
  /// Measured where several orders are asked for; methods that have but one leave it out.
  bool many_orders = false;
  /// How often an error that `auto` states may enter the quantity, which is no failure then.
  int stated_errors = 0;
  std::vector<double> sweep;  ///< values of the trigger
  double hardest = 0;         ///< the one of them that a short run measures
  /// The scene at a value of the trigger, as a document that leaves the method open.
  std::function<nlohmann::json(double)> scene = {};
  /// The quantity wherever it is looked for, each to be held against what was stated there;
  /// none where the method itself makes what the others are measured against.
  /// @throws BrokenFrame, SceneError, OverLimit, Cancelled
  std::function<std::vector<Measured>(Trial&, double)> measure = {};

  /// What may be measured: the bound, or what `auto` says itself, which is no failure.
  double allowed(double stated) const { return std::max(bound, stated_errors * stated); }
};

/// Nothing, or the one quantity.
std::vector<Measured> measured(const std::optional<Measured>& found);

/// All rows, by number.
const std::vector<StabilityRow>& stability_rows();

/// A scene to start from: three wavelengths, a sun of irradiance 1.
nlohmann::json plain_scene();
/// Without air, over black ground.
nlohmann::json empty_scene();
/// The scene with its top, its planet and its sun somewhere else; `patch` is a merge patch.
nlohmann::json changed(nlohmann::json scene, const nlohmann::json& patch);
/// What chance may add to a radiance in one of a million: five standard errors; 0 where none is
/// stated.
double noise_of(const Radiances& seen, std::size_t ray, std::size_t channel);
/// That of a sum of values, whose errors are independent, or else cancel: in quadrature.
double together(std::initializer_list<double> noises);
/// How much two radiances differ beyond their noise, over the larger one.
Measured apart(double a, double b, double noise);
/// The largest that `of(ray, channel)` says, 0 at least, and the largest noise.
Measured largest(std::size_t rays, const std::function<Measured(std::size_t, std::size_t)>& of);
/// The larger of the two, and the larger noise.
Measured larger(const Measured& a, const Measured& b);

// Its parts, a file each.
std::vector<StabilityRow> rows_of_rays();    ///< horizons, limbs, short and long paths
std::vector<StabilityRow> rows_of_suns();    ///< twilight, shadow edges, large suns
std::vector<StabilityRow> rows_of_airs();    ///< thin layers, peaks, pure and extreme media
std::vector<StabilityRow> rows_of_energy();  ///< closure and reciprocity
std::vector<StabilityRow> rows_of_work();    ///< how work is cut

}  // namespace cyanometer
