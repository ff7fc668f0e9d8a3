// The stability suite: every row, swept through every method and through what `auto` chooses.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/stability/row.h"

namespace cyanometer {

enum class Outcome {
  holds,      ///< the quantity is within its bound
  degrades,   ///< it is not
  breaks,     ///< a value is not finite, or a law has no number for how much it is broken
  refuses,    ///< by name
  left_out,   ///< orders that the method declares not to compute
  reference,  ///< the method is what the others are measured against
};
std::string name_of(Outcome outcome);

/// A row at one value of its trigger, by one method.
struct StabilityPoint {
  int row = 0;
  std::string method;
  double trigger = 0;
  Outcome outcome = Outcome::holds;
  double value = 0, least = 0;  ///< as in Measured, of what comes nearest to its bound
  double noise = 0;             ///< the largest of all that is measured
  double stated = 0;            ///< the error that `auto` stated for it
  std::string note = {};        ///< why it refuses, what breaks
};

struct StabilitySettings {
  std::filesystem::path references;  ///< folder in which they are kept; empty: nowhere
  double most_work = 1 << 21;        ///< random walks of one reference
};

/// The six methods and `auto`.
std::vector<std::string> stability_subjects();

/// @throws Cancelled, DeviceLost
StabilityPoint measure_point(Engine& engine, const StabilityRow& row, const std::string& method,
                             double trigger, const StabilitySettings& settings,
                             const Watch& watch = {});

nlohmann::json point_document(const StabilityPoint& point);
/// What point_document made. @throws nlohmann::json::exception
StabilityPoint stability_point_from(const nlohmann::json& document);

/// The errors of every method along one quantity of the scene: a row without a bound, number 0.
const std::vector<StabilityRow>& stability_curves();

}  // namespace cyanometer
