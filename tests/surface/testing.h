// Scenes on grounds that differ from place to place.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "engine/engine.h"
#include "engine/physics/pack.h"
#include "engine/scene/document.h"
#include "engine/surface/maps.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/composite/picture_file.h"
#include "tests/device.h"
#include "tests/oracle/scenes.h"

namespace cyanometer::surface_testing {

using P = Physics<double>;

/// Every matter alike, no sea, no relief: ground of one albedo, by another way.
inline ProceduralSurface even_world(double albedo) {
  ProceduralSurface surface;
  surface.sea_fraction = 0;
  surface.sea = surface.plants = surface.sand = surface.rock = surface.ice = albedo;
  return surface;
}

inline Scene scene_on(const Surface& surface, double altitude_km, double sun_elevation_deg,
                      const std::string& method = "raymarch") {
  Scene scene = oracle::reference_scene(altitude_km, sun_elevation_deg);
  scene.planet.surface = surface;
  scene.camera.latitude_deg = 20;
  scene.camera.longitude_deg = 30;
  scene.method.name = method;
  scene.method.scattering_orders = std::nullopt;
  for (const MethodDescription& each : methods()) {
    if (each.name != method) continue;
    scene.method.options.clear();
    for (const MethodOption& option : each.options) {
      scene.method.options[option.name] = option.default_value;
    }
  }
  return scene;
}

inline Scene without_air(Scene scene) {
  scene.atmosphere.constituents.clear();
  return scene;
}

/// A folder of maps for as long as it lives.
struct Maps {
  explicit Maps(std::size_t most_bytes = std::size_t{64} << 20) {
    use_surfaces(folder.path(), most_bytes);
  }
  ~Maps() { use_surfaces({}, 0); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
  }
  cyanometer::testing::TemporaryFolder folder;
};

/// An EXR of one number everywhere, or of what a function says of a place.
template <class Value>
std::string map_file(int width, const std::vector<std::string>& channels, Value value) {
  cyanometer::testing::Channels planes;
  for (const std::string& channel : channels) {
    std::vector<float>& plane = planes[channel];
    for (int y = 0; y < width / 2; ++y) {
      for (int x = 0; x < width; ++x) plane.push_back(static_cast<float>(value(x, y)));
    }
  }
  return cyanometer::testing::picture_file(width, width / 2, planes);
}

inline std::string grey_map(double albedo) {
  return map_file(16, {"R", "G", "B"}, [&](int, int) { return albedo; });
}

}  // namespace cyanometer::surface_testing
