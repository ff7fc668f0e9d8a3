// The mappings of the tables in double, and what is integrated on their nodes.
#include "engine/methods/bruneton/grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bruneton/bruneton_testing.h"

namespace cyanometer::bruneton {
namespace {

using P = Physics<double>;

constexpr double top_km = 100;
const std::vector<double> altitudes_km{0, 1e-6, 2e-3, 0.4, 10, 99, top_km - 1e-6, top_km};

P earth() {
  return pack<double>(make_problem(oracle::reference_scene(0, 30), {680, 550, 440}));
}

P::ScatteringGrid grid(int mapping, bool two_sided) {
  Problem problem = make_problem(oracle::reference_scene(0, 30), {680, 550, 440});
  Setup setup(with_options({{"mapping", mapping}, {"horizon", two_sided}}));
  ScatteringGrid g = all_rays(problem, setup).grid;
  return {g.altitudes,  g.zeniths,    g.suns,      g.azimuths,  g.mapping,   g.two_sided,
          g.highest_mu, g.lowest_sun, g.sun_shift, g.sun_width, g.sun_first, g.sun_span};
}

template <class Test>
void for_all_grids(Test test) {
  for (int mapping : {0, 1, 2}) {
    for (bool two_sided : {false, true}) test(grid(mapping, two_sided));
  }
}

TEST(Grid, AltitudesAndSunsComeBackFromTheirCoordinates) {
  P p = earth();
  for_all_grids([&](const P::ScatteringGrid& g) {
    for (double share = 0; share <= 1; share += 1.0 / 64) {
      EXPECT_NEAR(p.altitude_share(g, p.altitude_at(g, share)), share, 1e-9);
      EXPECT_NEAR(p.sun_share(g, p.sun_cosine_at(g, share)), share, 1e-6) << g.mapping;
    }
    EXPECT_EQ(p.altitude_at(g, 0), 0);
    EXPECT_NEAR(p.altitude_at(g, 1), top_km, 1e-9);
    EXPECT_NEAR(p.sun_cosine_at(g, 1), 1, 1e-6);
    EXPECT_NEAR(p.sun_cosine_at(g, 0), g.lowest_sun, 1e-6);
  });
}

TEST(Grid, ViewsComeBackFromTheirCoordinatesAtEveryAltitude) {
  P p = earth();
  for_all_grids([&](const P::ScatteringGrid& g) {
    for (double h : altitudes_km) {
      for (int i = 0; i <= 8 * (g.zeniths - 1); ++i) {
        double x = i / 8.0;
        bool between_sides = g.two_sided && x > g.zeniths / 2 - 1 && x < g.zeniths / 2;
        // At the top all paths upwards have no length.
        bool no_length = g.mapping == P::MAPPING_DISTANCES && h == top_km && x > g.zeniths - 2;
        if (between_sides || no_length) continue;
        double mu = p.zenith_cosine(g, h, x);
        bool below = g.two_sided ? x < g.zeniths / 2.0 - 0.5 : mu < p.horizon_cosine(h);
        EXPECT_NEAR(p.zenith_coordinate(g, h, mu, below), x, 1e-3)
            << "mapping " << g.mapping << " altitude " << h << " mu " << mu;
      }
    }
  });
}

TEST(Grid, JustAboveAndJustBelowTheHorizonAreDifferentNodes) {
  P p = earth();
  for (int mapping : {0, 1, 2}) {
    P::ScatteringGrid g = grid(mapping, true);
    for (double h : altitudes_km) {
      double horizon = p.horizon_cosine(h), above = std::nextafter(horizon, 1),
             under = std::nextafter(horizon, -1);
      EXPECT_NEAR(p.zenith_coordinate(g, h, above, false), g.zeniths / 2, 1e-2);
      EXPECT_NEAR(p.zenith_coordinate(g, h, under, true), g.zeniths / 2 - 1, 1e-2);
      EXPECT_NEAR(p.zenith_cosine(g, h, g.zeniths / 2 - 1), horizon, 1e-12);
      EXPECT_NEAR(p.zenith_cosine(g, h, g.zeniths / 2), horizon, 1e-12);
    }
  }
}

TEST(Grid, ViewsAscendFromTheNadirToTheZenith) {
  P p = earth();
  for_all_grids([&](const P::ScatteringGrid& g) {
    for (double h : altitudes_km) {
      EXPECT_NEAR(p.zenith_cosine(g, h, 0), -1, 1e-9);
      EXPECT_NEAR(p.zenith_cosine(g, h, g.zeniths - 1), 1, 1e-9);
      for (int z = 0; z + 1 < g.zeniths; ++z) {
        EXPECT_LE(p.zenith_cosine(g, h, z), p.zenith_cosine(g, h, z + 1) + 1e-12)
            << "mapping " << g.mapping << " altitude " << h << " node " << z;
      }
    }
  });
}

TEST(Grid, ItsWeightsIntegratePolynomialsOverTheSphere) {
  Problem problem = make_problem(oracle::reference_scene(0, 30), {680, 550, 440});
  for (int mapping : {0, 2}) {
    bruneton::Setup setup(with_options({{"mapping", mapping}}));
    Rays rays = all_rays(problem, setup);
    const float* cosines = rays.nodes.data() + rays.grid.altitudes + rays.grid.suns;
    const float* weights = cosines + rays.count();
    for (int a = 0; a < rays.grid.altitudes; ++a) {
      for (int power = 0; power <= 4; ++power) {
        double sum = 0;
        for (int z = 0; z < rays.grid.zeniths; ++z) {
          int node = a * rays.grid.zeniths + z;
          sum += weights[node] * std::pow(cosines[node], power);
        }
        EXPECT_NEAR(sum, power % 2 == 0 ? 2.0 / (power + 1) : 0, 1e-4)
            << "mapping " << mapping << " altitude node " << a << " power " << power;
      }
    }
  }
}

TEST(Grid, ReachesTheSunsThatLightTheAirOfAnyPlanet) {
  for (auto [radius_km, thickness_km] :
       {std::pair{6360.0, 100.0}, {6360.0, 200.0}, {50.0, 20.0}, {1e6, 100.0}}) {
    Scene scene = oracle::reference_scene(0, 30);
    scene.planet.radius_km = radius_km;
    scene.atmosphere.thickness_km = thickness_km;
    ScatteringGrid g =
        all_rays(make_problem(scene, {680, 550, 440}), bruneton::Setup(with_options({}))).grid;
    // Light that grazes the ground leaves the air where the sun is one dip below the horizon,
    // and is seen there from the ground another dip on.
    double dip = std::acos(radius_km / (radius_km + thickness_km));
    EXPECT_LT(std::asin(g.lowest_sun), -2 * dip + 1e-6);
  }
}

}  // namespace
}  // namespace cyanometer::bruneton
