// A row of the stability suite: scenes that are known to break methods, what is measured on
// them, and how large it may be.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "engine/accuracy/error.h"
#include "engine/stability/trial.h"

namespace cyanometer {

constexpr double degree = std::numbers::pi / 180;  ///< in radians

/// What a row's quantity came to; `least` is what of it is beyond the noise of its reference.
struct Measured {
  Measured(double value_) : value(value_), least(value_) {}
  Measured(const EstimatedError& error) : value(error.measure.error), least(error.low) {}
  double value, least;
};

/// The larger of the two, by what is beyond noise.
Measured larger(const Measured& a, const Measured& b);

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
  /// None where the method itself makes what the others are measured against.
  /// @throws BrokenFrame, SceneError, OverLimit, Cancelled
  std::function<std::optional<Measured>(Trial&, double)> measure = {};
};

/// All rows, by number.
const std::vector<StabilityRow>& stability_rows();

/// A scene to start from: three wavelengths, a sun of irradiance 1.
nlohmann::json plain_scene();
/// Without air, over black ground.
nlohmann::json empty_scene();
/// The scene with its top, its planet and its sun somewhere else; `patch` is a merge patch.
nlohmann::json changed(nlohmann::json scene, const nlohmann::json& patch);
/// How much two radiances differ beyond their noise, over the larger one.
double apart(double a, double b, double noise);
/// The largest that `of(ray, channel)` says, 0 at least.
double largest(std::size_t rays, const std::function<double(std::size_t, std::size_t)>& of);
/// What chance may add to a radiance in one of a million: five standard errors; 0 where none is
/// stated.
double noise_of(const Radiances& seen, std::size_t ray, std::size_t channel);

// Its parts, a file each.
std::vector<StabilityRow> rows_of_rays();    ///< horizons, limbs, short and long paths
std::vector<StabilityRow> rows_of_suns();    ///< twilight, shadow edges, large suns
std::vector<StabilityRow> rows_of_airs();    ///< thin layers, peaks, pure and extreme media
std::vector<StabilityRow> rows_of_energy();  ///< closure and reciprocity
std::vector<StabilityRow> rows_of_work();    ///< how work is cut

}  // namespace cyanometer
