// The makers of Bruneton's tables by themselves.
#pragma once

#include "engine/methods/bruneton/tables.h"
#include "tests/bruneton/bruneton_testing.h"

namespace cyanometer {

/// What a method is given to work with, without an engine.
struct Workshop {
  vulkan::Device device;
  vulkan::Commands commands{device};
  Pacer pacer{50};
  TableCache tables{std::size_t{64} << 20};
  Watch watch;
  Tracer tracer{device, commands, pacer, tables, watch};
  bruneton::TableMaker maker{device};

  UploadedScene upload(double altitude_km, double sun_deg) {
    Scene scene = hazy(altitude_km, sun_deg, std::nullopt, {});
    return {device, make_problem(scene, {680, 550, 440})};
  }
};

}  // namespace cyanometer
