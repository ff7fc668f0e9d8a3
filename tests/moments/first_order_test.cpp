// Order one read from a table of the sky instead of marched in every pixel: the same light.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/engine.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Radiances traced(const json& document, bool march) {
  Scene scene = read_scene(document);
  Plan plan;
  plan.method = "moments";
  for (const MethodDescription& method : methods()) {
    if (method.name != plan.method) continue;
    for (const MethodOption& option : method.options) {
      plan.options[option.name] = option.default_value;
    }
  }
  plan.options["march_pixels"] = march;
  plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
  return device().radiance(scene, sample_directions(scene, 256), false, plan);
}

json sky(double altitude_km, double sun_elevation_deg) {
  return {{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
          {"camera", {{"altitude_km", altitude_km}}},
          {"image", {{"width", 160}, {"height", 90}}},
          {"sun", {{"elevation_deg", sun_elevation_deg}, {"azimuth_deg", 20}}}};
}

TEST(MomentsFirstOrder, ReadIsAsMarched) {
  for (double altitude_km : {0.002, 5.0, 15.0}) {
    for (double elevation_deg : {70.0, 20.0, 5.0}) {
      json scene = sky(altitude_km, elevation_deg);
      Radiances read = traced(scene, false), marched = traced(scene, true);
      EXPECT_LT(measure_error(read.radiance, marched.radiance).error, 5e-3)
          << altitude_km << " km, sun " << elevation_deg;
      for (std::size_t i = 0; i < read.transmittance.size(); ++i) {
        for (std::size_t w = 0; w < 3; ++w) {
          EXPECT_NEAR(read.transmittance[i][w], marched.transmittance[i][w], 1e-3);
        }
      }
    }
  }
}

TEST(MomentsFirstOrder, IsReadInHazeOfWhichSomeCountsAsNotScattered) {
  json scene = sky(0.002, 25);
  scene["atmosphere"]["constituents"]["aerosol"]["optical_depth"] = 0.5;
  EXPECT_LT(measure_error(traced(scene, false).radiance, traced(scene, true).radiance).error,
            1e-2);
}

TEST(MomentsFirstOrder, IsMarchedWhereNoTableCanStandForIt) {
  std::vector<json> scenes{sky(400, 30), sky(0.002, 30), sky(0.002, 30)};
  scenes[0]["camera"]["pitch_deg"] = -70;
  scenes[1]["sun"]["distance_km"] = 10000;
  scenes[2]["sun"].update({{"disc_samples", 4}, {"angular_diameter_deg", 10}});
  for (const json& scene : scenes) {
    EXPECT_EQ(traced(scene, false).radiance, traced(scene, true).radiance) << scene;
  }
}

}  // namespace
}  // namespace cyanometer
