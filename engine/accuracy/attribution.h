// Where the error of a method comes from: what each of its causes alone is worth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/accuracy/error.h"
#include "engine/accuracy/reference.h"
#include "engine/engine.h"

namespace cyanometer {

struct ErrorShare {
  std::string cause;
  double error = 0;  ///< in the contract's measure
  std::string how;   ///< what was compared, in words
};

struct Attribution {
  Plan plan;                       ///< the setting that was looked at
  EstimatedError error;            ///< of it as a whole, against the reference
  double reference_noise = 0;      ///< in the same measure
  std::vector<ErrorShare> shares;  ///< they need not add up: errors may cancel
};

/// The scene by the plan that it asks for, on stratified rays. Causes are
/// - "quadrature", "tables": the change by numbers of nodes and samples that are four times as
///   large, by sizes of tables that are twice as large (less where the device has no room for
///   them) and switches that are at their best; a rule of order p leaves 4^-p, 2^-p of its
///   error out of it;
/// - "orders": scattering orders that the method does not compute, as the reference has them;
///   of those that extrapolate them the change by twice as many;
/// - "model": what is left against the reference with all of these refined, or of methods of
///   order one, with nodes 32 times as many, against order one by the finest quadrature;
/// - "wavelengths": of colours the change by 32 wavelengths, where the scene leaves them open;
/// - "walks": of random methods their noise, from another seed.
/// What a method has none of is left out. The error of floats is another engine's matter
/// (precision.h).
/// @param references  folder where they are kept; empty: nowhere
/// @throws OverLimit, Cancelled, DeviceLost
Attribution attribute(Engine& engine, const Scene& scene, const ReferenceGoal& goal,
                      const std::filesystem::path& references, const Watch& watch = {});

}  // namespace cyanometer
