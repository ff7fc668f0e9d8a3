// What follows from a procedural surface as a whole: where its sea stands, and what it is made
// of on average.
#pragma once

#include <array>

#include "engine/physics/physics.h"
#include "engine/scene/scene.h"

namespace cyanometer {

struct World {
  double sea_level = 0;  ///< of continents (shaders/surface/terrain.glsl)
  /// By matter (shaders/surface/data.glsl), of the whole sphere's area, to two digits: worlds
  /// of different seeds share the tables that depend on it.
  std::array<double, physics::Physics<double>::MATTERS> mean_share{};
};

/// Kept for all surfaces asked for, so cheap but for the first time.
World world_of(const ProceduralSurface& surface);

/// Of the octaves of continents and mountains, each over the one before.
double terrain_gain(const ProceduralSurface& surface);
/// Mean squared slope of the sea [Cox and Munk 1954, eq. 16].
double sea_slope_variance(const ProceduralSurface& surface);
/// What a sea whose waves have such slopes reflects of an even sky (shaders/surface/sea.glsl).
struct SeaReflectance {
  std::array<double, physics::Physics<double>::SEA_NODES> by_cosine{};
  double mean = 0;
};
SeaReflectance sea_reflectance(double slope_variance);

}  // namespace cyanometer
