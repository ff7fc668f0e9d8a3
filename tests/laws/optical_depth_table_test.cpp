// The table of optical depths: its mapping and its interpolation in double, its values on the
// device.
#include "engine/methods/tables/optical_depth_table.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "tests/laws/optical_depths.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

Problem problem_of(const nlohmann::json& document) {
  return make_problem(read_scene(document), {440, 550, 680});
}

P planet(double radius_km, double thickness_km) {
  P p;
  p.scene.planet_radius_km = radius_km;
  p.scene.thickness_km = thickness_km;
  return p;
}

/// Zenith cosines of rays that pass the ground by, from the horizon to the zenith.
std::vector<double> cosines_above_the_horizon(P& p, double h) {
  double horizon = -std::sqrt(p.squared_height(h)) / (p.scene.planet_radius_km + h);
  std::vector<double> all;
  for (double share : {1e-9, 1e-6, 1e-4, 0.01, 0.1, 0.4, 0.8, 0.999, 1.0}) {
    all.push_back(horizon + (1 - horizon) * share);
  }
  return all;
}

TEST(OpticalDepthTable, ARayAndItsCoordinatesAreTheSame) {
  for (P p : {planet(6360, 100), planet(50, 20), planet(1e6, 500), planet(6360, 2000)}) {
    double top = p.scene.thickness_km;
    for (double h : {0.0, 1e-6, 2e-3, 0.1, 0.02 * top, 0.5 * top, 0.999 * top}) {
      for (double mu : cosines_above_the_horizon(p, h)) {
        auto ray = p.optical_depth_ray(p.optical_depth_coordinates(h, mu));
        EXPECT_NEAR(ray.altitude_km, h, 1e-12 * top);
        EXPECT_NEAR(ray.mu, mu, 1e-9) << "h " << h;
      }
    }
  }
}

TEST(OpticalDepthTable, CoordinatesAreThoseOfTheirRay) {
  for (P p : {planet(6360, 100), planet(50, 20), planet(1e6, 500)}) {
    for (double u : {0.0, 1e-3, 0.2, 0.7, 1.0}) {
      for (double v : {0.0, 1e-3, 0.3, 0.8, 0.999}) {
        auto ray = p.optical_depth_ray({u, v});
        auto at = p.optical_depth_coordinates(ray.altitude_km, ray.mu);
        EXPECT_NEAR(at.x, u, 1e-8);
        EXPECT_NEAR(at.y, v, 1e-9);
      }
    }
  }
}

TEST(OpticalDepthTable, BelowTheHorizonIsAtTheHorizonsEnd) {
  P p = planet(6360, 100);
  EXPECT_EQ(p.optical_depth_coordinates(0.002, -0.03).x, 1);
  EXPECT_EQ(p.optical_depth_coordinates(40, -0.5).x, 1);
}

TEST(OpticalDepthTable, NothingLiesAboveTheTop) {
  P p = planet(6360, 100);
  auto ray = p.optical_depth_ray({0, 1});
  EXPECT_NEAR(ray.altitude_km, 100, 1e-9);
  EXPECT_NEAR(p.distance_to_top(ray.altitude_km, ray.mu), 0, 1e-9);
}

/// The largest error of the transmittance that interpolation makes.
double worst_transmittance(const Problem& problem, OpticalDepthSize size) {
  P p = with_optical_depths(pack<double>(problem), size);
  double worst = 0;
  for (double h : {0.0, 0.002, 0.07, 0.4, 1.3, 3.0, 9.0, 27.0, 60.0, 99.0}) {
    for (double mu : cosines_above_the_horizon(p, h)) {
      double columns[P::MEDIA_SIZE];
      p.columns_to_top(h, mu, columns);
      glm::dvec4 exact = p.transmittance_of(columns, 0);
      glm::dvec4 found =
          glm::exp(-p.tabulated_optical_depth(p.optical_depth_position(h, mu), 0));
      for (int w = 0; w < 3; ++w) worst = std::max(worst, std::abs(found[w] - exact[w]));
    }
  }
  return worst;
}

TEST(OpticalDepthTable, InterpolatesWithTheSquareOfItsSpacing) {
  Problem earth = problem_of(nlohmann::json::object());
  double coarse = worst_transmittance(earth, {128, 32});
  double usual = worst_transmittance(earth, {256, 64});
  double fine = worst_transmittance(earth, {512, 128});
  std::printf("transmittance: 128 x 32 %.1e, 256 x 64 %.1e, 512 x 128 %.1e\n", coarse, usual,
              fine);
  EXPECT_LT(usual, 2e-3);
  EXPECT_LT(usual, coarse / 2.5);
  EXPECT_LT(fine, usual / 2.5);
}

struct OnDevice {
  explicit OnDevice(double longest_dispatch_ms) : pacer(longest_dispatch_ms) {}

  std::vector<glm::vec4> table(const Problem& problem, OpticalDepthSize size) {
    Tracer tracer{device, commands, pacer, tables, watch};
    UploadedScene scene(device, problem);
    auto made = maker.get(tracer, scene, size);
    EXPECT_EQ(maker.get(tracer, scene, size), made);
    std::vector<glm::vec4> values(made->bytes() / sizeof(glm::vec4));
    made->values().read(0, std::as_writable_bytes(std::span(values)));
    return values;
  }

  vulkan::Device device;
  vulkan::Commands commands{device};
  Pacer pacer;
  TableCache tables{1 << 24};
  Watch watch;
  OpticalDepthTableMaker maker{device};
};

nlohmann::json with_a_long_table() {
  nlohmann::json altitudes = nlohmann::json::array(), densities = altitudes;
  for (int i = 0; i < 4096; ++i) {
    altitudes.push_back(i * 0.02);
    densities.push_back(std::exp(-i * 0.02 / 8));
  }
  return {
      {"atmosphere",
       {{"constituents",
         {{"air",
           {{"profile",
             {{"type", "table"}, {"altitude_km", altitudes}, {"density", densities}}}}}}}}}};
}

TEST(OpticalDepthTable, OnTheDeviceHoldsColumnsTimesExtinction) {
  OnDevice gpu(50);
  for (const nlohmann::json& document : {nlohmann::json::object(), with_a_long_table()}) {
    Problem problem = problem_of(document);
    OpticalDepthSize size{32, 8};
    std::vector<glm::vec4> found = gpu.table(problem, size);
    P exact = with_optical_depths(pack<double>(problem), size);
    ASSERT_EQ(found.size(), exact.optical_depths.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (int w = 0; w < 3; ++w) {
        double expected = exact.optical_depths[i][w];
        EXPECT_NEAR(found[i][w], expected, 2e-4 * expected + 1e-7) << "texel " << i;
      }
    }
  }
}

TEST(OpticalDepthTable, DoesNotDependOnHowItsWorkIsCut) {
  Problem problem = problem_of(nlohmann::json::object());
  EXPECT_EQ(OnDevice(1e-4).table(problem, {40, 20}), OnDevice(50).table(problem, {40, 20}));
}

}  // namespace
}  // namespace cyanometer
