// What turned roundings say of the precision of floats, against the same march in double.
#include "engine/accuracy/precision.h"

#include <gtest/gtest.h>

#include "engine/accuracy/error.h"
#include "tests/device.h"
#include "tests/oracle/march.h"
#include "tests/oracle/scenes.h"

namespace cyanometer::oracle {
namespace {

PrecisionTrial& trial() {
  static PrecisionTrial trial("llvmpipe");  // whose rounding can be turned
  return trial;
}

/// The error of the device's march in float, measured with that in double.
double error_of_floats(const Scene& scene, const Radiances& found,
                       const std::vector<Direction>& directions) {
  P p = pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm));
  std::vector<std::vector<double>> exact;
  for (const Direction& d : directions) {
    Ray ray = march(p, towards(d.elevation_deg, d.azimuth_deg),
                    static_cast<int>(scene.method.options.at("view_samples")),
                    static_cast<int>(scene.method.options.at("light_samples")));
    exact.emplace_back();
    for (std::size_t w = 0; w < 3; ++w)
      exact.back().push_back(ray.inscatter[w] + ray.ground[w]);
  }
  return measure_error(found.radiance, exact).error;
}

TEST(Precision, OfTurnedRoundingsIsThatOfFloats) {
  for (auto [altitude_km, sun_deg] : {std::pair(0.0, 60.0), {0.0, 5.0}, {10.0, -4.0}}) {
    Scene scene = reference_scene(altitude_km, sun_deg, 0.3);
    for (const MethodOption& option : methods().front().options)
      scene.method.options[option.name] = option.default_value;
    const std::vector<Direction> directions = sample_directions(scene, 256);
    const double floats =
        error_of_floats(scene, device().radiance(scene, directions, false), directions);
    const double turned = trial().measure(scene, "nishita", {}).error;
    std::printf("%g km, sun at %g deg: floats are wrong by %.1e, turned roundings say %.1e\n",
                altitude_km, sun_deg, floats, turned);
    EXPECT_GT(turned, floats / 2);
    EXPECT_LT(turned, floats * 20);
  }
}

TEST(Precision, IsFarBelowEveryMethodsError) {
  Scene scene = reference_scene(0, 20, 0.3);
  scene.method.scattering_orders = -1;
  for (const MethodDescription& method : methods()) {
    const PrecisionPoint point = trial().measure(scene, method.name, {});
    EXPECT_LT(std::abs(point.error), 5e-4 + 4 * point.noise) << method.name;
    EXPECT_NE(point.error, 0) << method.name;
  }
}

}  // namespace
}  // namespace cyanometer::oracle
