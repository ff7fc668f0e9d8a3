// Scenes and options for the tests of Bruneton's tables.
#pragma once

#include "engine/engine.h"
#include "engine/methods/bruneton/bruneton.h"
#include "tests/device.h"
#include "tests/oracle/scenes.h"

namespace cyanometer {

/// The method's defaults with some options changed.
inline MethodOptions with_options(const MethodOptions& changed) {
  MethodOptions options;
  for (const MethodOption& option : bruneton_description().options) {
    options[option.name] = option.default_value;
  }
  for (const auto& [name, value] : changed) options.at(name) = value;
  return options;
}

/// Small tables, which take a moment.
inline MethodOptions small_tables(MethodOptions changed = {}) {
  MethodOptions options{{"altitudes", 8}, {"zeniths", 10},       {"suns", 16},
                        {"azimuths", 7},  {"source_zeniths", 9}, {"source_azimuths", 5},
                        {"samples", 16},  {"refinement", 2}};
  for (const auto& [name, value] : changed) options[name] = value;
  return with_options(options);
}

inline void use(Scene& scene, std::optional<int> orders, const MethodOptions& options) {
  scene.method.name = "bruneton";
  scene.method.scattering_orders = orders;
  scene.method.options = options;
}

/// Earth's air with haze and ozone (tests/oracle/scenes.h).
inline Scene hazy(double altitude_km, double sun_elevation_deg, std::optional<int> orders,
                  const MethodOptions& options) {
  Scene scene = oracle::reference_scene(altitude_km, sun_elevation_deg, 0.3);
  use(scene, orders, options);
  return scene;
}

/// Over the sky and the ground of a camera in the air, evenly in the square root of the angle
/// from the horizon.
inline std::vector<Direction> all_around(int count) {
  std::vector<Direction> directions;
  for (int i = 0; i < count; ++i) {
    double x = 2 * (i + 0.5) / count - 1;
    directions.push_back({90 * x * std::abs(x), std::fmod(137.50776 * i, 360)});
  }
  return directions;
}

}  // namespace cyanometer
