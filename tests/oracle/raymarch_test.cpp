#include <gtest/gtest.h>

#include "engine/accuracy/adaptive.h"
#include "tests/device.h"
#include "tests/oracle/scenes.h"

namespace cyanometer::oracle {
namespace {

Scene raymarched(double altitude_km, double sun_elevation_deg, int view_nodes = 6) {
  Scene scene = reference_scene(altitude_km, sun_elevation_deg, 0.3);
  scene.method.name = "raymarch";
  scene.method.options = {{"view_nodes", view_nodes}};
  return scene;
}

double horizon_deg(double altitude_km) {
  return -glm::degrees(std::acos(6360 / (6360 + altitude_km)));
}

/// Spread evenly, and gathered about the horizon, none within 0.01 degrees of it.
std::vector<Direction> views(double altitude_km) {
  std::vector<Direction> directions = spread_directions(altitude_km, 24);
  for (double offset : {-1.0, -0.3, -0.02, 0.02, 0.1, 0.4, 1.5}) {
    for (double azimuth : {0.0, 25.0, 180.0}) {
      directions.push_back({horizon_deg(altitude_km) + offset, azimuth});
    }
  }
  return directions;
}

struct Samples {
  std::vector<double> found, exact;
  double peak() const { return *std::max_element(exact.begin(), exact.end()); }
  /// Relative to |L|, with a floor of a tenth of the frame's peak.
  void add_errors(std::vector<double>& errors) const {
    for (std::size_t i = 0; i < exact.size(); ++i) {
      errors.push_back(std::abs(found[i] - exact[i]) / (exact[i] + 0.1 * peak()));
    }
  }
};

Samples sample(const Scene& scene, const std::vector<Direction>& directions) {
  Adaptive integral(pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm)));
  Radiances radiances = device().radiance(scene, directions, false);
  Samples result;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    Ray ray = integral.trace(towards(directions[i].elevation_deg, directions[i].azimuth_deg));
    for (std::size_t w = 0; w < 3; ++w) {
      result.found.push_back(radiances.radiance[i][w]);
      result.exact.push_back(ray.inscatter[w] + ray.ground[w]);
      // In float a limb seen from afar is known to a fraction of a metre of its height.
      double depth = -std::log(ray.transmittance[w] + 1e-30);
      EXPECT_NEAR(-std::log(radiances.transmittance[i][w] + 1e-30), depth, 3e-4 * (1 + depth));
    }
  }
  return result;
}

double percentile(std::vector<double> values, int percent) {
  std::sort(values.begin(), values.end());
  return values[(values.size() - 1) * percent / 100];
}

TEST(Raymarch, AtItsDefaultIsTheAdaptiveIntegralFromTheGroundToDeepSpaceAndIntoTwilight) {
  std::vector<double> errors;
  for (double altitude_km : {0.0, 0.002, 0.3, 1.0, 10.0, 50.0, 99.9, 400.0, 36000.0}) {
    for (double sun : {90.0, 60.0, 20.0, 5.0, 0.0, -2.0, -4.0, -6.0, -9.0, -12.0}) {
      Samples frame = sample(raymarched(altitude_km, sun), views(altitude_km));
      for (std::size_t i = 0; i < frame.exact.size(); ++i) {
        EXPECT_NEAR(frame.found[i], frame.exact[i], 1e-3 * frame.exact[i] + 1e-4 * frame.peak())
            << altitude_km << " km, sun " << sun << " deg, value " << i;
      }
      frame.add_errors(errors);
    }
  }
  std::printf("%zu values: median %.1e, p99 %.1e, largest %.1e\n", errors.size(),
              percentile(errors, 50), percentile(errors, 99), percentile(errors, 100));
  EXPECT_LT(percentile(errors, 99), 1e-4);
}

/// The scene with another haze.
Scene hazy(double altitude_km, double sun, double factor, int view_nodes) {
  Scene scene = raymarched(altitude_km, sun, view_nodes);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2},
      Particles{ParticleCoefficients{0.003996 * factor, 0.000444 * factor},
                CornetteShanks{0.8}}};
  return scene;
}

TEST(Raymarch, ConvergesAlsoInThickHazeAtSunset) {
  double last = 1;
  for (int nodes : {4, 8, 16, 32}) {
    std::vector<double> errors;
    for (double altitude_km : {0.0, 2.0, 400.0}) {
      for (double sun : {20.0, 0.0, -4.0}) {
        sample(hazy(altitude_km, sun, 100, nodes), views(altitude_km)).add_errors(errors);
      }
    }
    double p99 = percentile(errors, 99);
    EXPECT_LT(p99, std::max(0.5 * last, 5e-5)) << nodes << " nodes";
    last = p99;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(Raymarch, UnderANearSunIsTheFineMarchOfNishita) {
  for (double distance_km : {7000.0, 20000.0}) {
    for (double sun : {60.0, 2.0, -1.0}) {
      Scene scene = raymarched(1, sun);
      scene.sun.distance_km = distance_km;
      Scene fine = scene;
      fine.method.name = "nishita";
      fine.method.options = {{"view_samples", 1000}, {"light_samples", 400}};
      std::vector<Direction> directions = views(1);
      auto found = device().radiance(scene, directions, false).radiance;
      auto exact = device().radiance(fine, directions, false).radiance;
      double peak = 0;
      for (const auto& ray : exact) peak = std::max(peak, *std::ranges::max_element(ray));
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::size_t w = 0; w < 3; ++w) {
          EXPECT_NEAR(found[i][w], exact[i][w], 3e-3 * exact[i][w] + 1e-3 * peak)
              << distance_km << " km, sun " << sun << ", direction " << i;
        }
      }
    }
  }
}

TEST(Raymarch, DoesNotDependOnHowItsWorkIsCut) {
  Scene scene = raymarched(0.5, 4);
  scene.sun.disc_samples = 3;
  std::vector<Direction> directions;
  for (int i = 0; i < 3000; ++i) directions.push_back({-20 + 0.03 * i, 0.11 * i});
  Engine slicing({.device = "", .longest_dispatch_ms = 1e-4});
  Radiances sliced = slicing.radiance(scene, directions, false);
  Radiances whole = device().radiance(scene, directions, false);
  EXPECT_EQ(sliced.radiance, whole.radiance);
  EXPECT_EQ(sliced.transmittance, whole.transmittance);
}

TEST(Raymarch, FollowsATabulatedSlabOfDust) {
  Scene scene = raymarched(0.002, 30, 8);
  scene.atmosphere.constituents["slab"] = {
      TableProfile{{0, 4, 4.2, 5, 5.2}, {0, 0, 1, 1, 0}},
      Particles{ParticleCoefficients{0.2, 0.02}, CornetteShanks{0.6}}};
  std::vector<double> errors;
  sample(scene, views(0.002)).add_errors(errors);
  EXPECT_LT(percentile(errors, 99), 2e-4);
}

}  // namespace
}  // namespace cyanometer::oracle
