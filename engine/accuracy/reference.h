// The converged solution of a scene along some of its rays, kept on disk: `path`, run until its
// noise is small, as two independent halves.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct Reference {
  std::vector<Direction> directions;
  /// [half][direction][wavelength], per unit of the sun's irradiance: two estimates with
  /// nothing in common.
  std::array<std::vector<std::vector<double>>, 2> halves;
  std::int64_t walks = 0;  ///< along each direction, in each half
  /// The error of the halves' mean, in the contract's measure: of X, Y, Z where the scene's
  /// wavelengths become a colour.
  double noise = 0;
};

/// When a reference is good enough.
struct ReferenceGoal {
  int rays = 512;
  double noise = 0.003;
  std::int64_t most_walks = 16384;  ///< along a ray in each half, however noisy that leaves it
};
/// What was measured towards another goal is another measurement.
nlohmann::json goal_document(const ReferenceGoal& goal);

/// The reference on `goal.rays` stratified rays of the scene. Walks are added to what `folder`
/// keeps of the same scene and version, and kept again after every pass, so that work that
/// was cancelled goes on. A reference of one order or none has no noise and one pass. Its
/// random numbers are none that `path` can be asked for.
/// @param folder  empty: nothing is kept
/// @param scene has its wavelengths given; its method and its display do not matter
/// @throws OverLimit, Cancelled, DeviceLost
Reference make_reference(Engine& engine, const Scene& scene, const ReferenceGoal& goal,
                         const std::filesystem::path& folder, const Watch& watch = {});
/// The same along given rays; `goal.rays` is idle.
Reference make_reference(Engine& engine, const Scene& scene,
                         const std::vector<Direction>& directions, const ReferenceGoal& goal,
                         const std::filesystem::path& folder, const Watch& watch = {});

}  // namespace cyanometer
