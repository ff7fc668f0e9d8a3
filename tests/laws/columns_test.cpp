// Columns along rays, by the shaders' quadrature, against the adaptive oracle's.
#include <gtest/gtest.h>

#include "engine/accuracy/adaptive.h"
#include "engine/physics/pack.h"

namespace cyanometer {
namespace {

Problem shell(double radius_km, double thickness_km, const std::vector<Profile>& profiles) {
  Problem problem;
  problem.planet_radius_km = radius_km;
  problem.thickness_km = thickness_km;
  problem.wavelengths_nm = {550};
  problem.ground_albedo = {0};
  problem.limb_darkening_exponent = {0};
  problem.sun_direction = {0, 0, 1};
  for (const Profile& profile : profiles) {
    problem.media.push_back({"m", profile, {1}, {0}, HenyeyGreenstein{0}});
  }
  return problem;
}

/// The largest relative difference over altitudes and directions to the top, where a column is
/// not vanishing.
double worst_difference(const Problem& problem, int nodes = 8) {
  Physics<double> p = pack<double>(problem);
  p.COLUMN_NODES = nodes;
  oracle::Adaptive exact(pack<double>(problem));
  double worst = 0;
  for (double share : {0.0, 1e-5, 0.003, 0.03, 0.1, 0.3, 0.6, 0.99}) {
    for (double elevation_deg = -12; elevation_deg <= 90; elevation_deg += 0.7) {
      double h = share * problem.thickness_km, mu = std::sin(glm::radians(elevation_deg));
      if (p.meets_ground(h, mu)) continue;
      double found[Physics<double>::MEDIA_SIZE];
      p.columns_to_top(h, mu, found);
      auto expected = exact.column(h, mu, p.distance_to_top(h, mu));
      for (int c = 0; c < p.MEDIA; ++c) {
        double difference = std::abs(found[c] - expected[c]) / (expected[c] + 1e-4);
        worst = std::max(worst, difference);
      }
    }
  }
  return worst;
}

TEST(Columns, OfEarthsAirHazeAndOzoneAreWithinAFewPartsIn100000) {
  Problem earth = shell(6360, 100,
                        {ExponentialProfile{8}, ExponentialProfile{1.2}, TentProfile{25, 15},
                         QuadraticProfile{}, UniformProfile{}});
  EXPECT_LT(worst_difference(earth), 2e-5);
}

TEST(Columns, OfThinAndThickLayersAreWithinAFewPartsIn100000) {
  EXPECT_LT(
      worst_difference(shell(6360, 100, {ExponentialProfile{0.2}, ExponentialProfile{40}})),
      2e-5);
  EXPECT_LT(worst_difference(shell(6360, 1000, {ExponentialProfile{60}})), 2e-5);
}

TEST(Columns, OnSmallPlanetsAreWithinAFewPartsIn10000) {
  Problem small = shell(50, 20, {ExponentialProfile{3}, TentProfile{8, 5}, QuadraticProfile{}});
  EXPECT_LT(worst_difference(small), 3e-4);
  small = shell(400, 60, {ExponentialProfile{12}, TentProfile{30, 20}, UniformProfile{}});
  EXPECT_LT(worst_difference(small), 3e-4);
}

TEST(Columns, OfTentsWiderThanThePlanetAreWithinAFewPartsIn10000) {
  EXPECT_LT(worst_difference(shell(6360, 100, {TentProfile{1700, 1e5}, TentProfile{0, 13000}})),
            2e-5);
  EXPECT_LT(worst_difference(shell(50, 20, {TentProfile{8, 60}, TentProfile{0, 200}})), 3e-4);
}

TEST(Columns, OfHalfTheNodesAreWithinSixParts1000) {
  Problem earth = shell(6360, 100,
                        {ExponentialProfile{8}, ExponentialProfile{1.2}, TentProfile{25, 15},
                         QuadraticProfile{}, UniformProfile{}});
  EXPECT_LT(worst_difference(earth, 4), 6e-3);
}

TEST(Columns, OfATabulatedProfileFollowItsNodes) {
  TableProfile table{{0, 5, 11, 20, 32, 47, 71, 86},
                     {1, 0.601, 0.297, 0.0726, 0.0108, 0.00117, 5.2e-5, 5.7e-6}};
  EXPECT_LT(worst_difference(shell(6360, 100, {table})), 1e-4);
  TableProfile slab{{0, 10, 10.5, 12, 13}, {0, 0, 1, 0.5, 0}};
  EXPECT_LT(worst_difference(shell(6360, 100, {slab})), 1e-4);
}

}  // namespace
}  // namespace cyanometer
