// The mappings of the tables, the cut at the planet's shadow and the series of orders, in
// double.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/methods/hillaire/forward_peak.h"
#include "engine/scene/document.h"
#include "tests/laws/optical_depths.h"

namespace cyanometer {
namespace {

using P = Physics<double>;
using nlohmann::json;

P planet(double radius_km, double thickness_km) {
  P p;
  p.scene.planet_radius_km = radius_km;
  p.scene.thickness_km = thickness_km;
  return p;
}

const std::vector<P>& planets() {
  static const std::vector<P> all{planet(6360, 100), planet(50, 20), planet(1e6, 500)};
  return all;
}

TEST(HillaireTables, AnElevationAndItsCoordinateAreTheSameNextToTheHorizonToo) {
  for (P p : planets()) {
    double top = p.scene.thickness_km;
    for (double h : {0.0, 1e-6, 0.002, 0.1 * top, top}) {
      double horizon = p.horizon_cosine(h);
      for (double offset : {1e-9, 1e-6, 1e-3, 0.3, 1.0}) {
        double above = horizon + offset * (1 - horizon);
        double below = horizon - offset * (1 + horizon);
        double up = p.elevation_coordinate(h, above, false);
        double down = p.elevation_coordinate(h, below, true);
        EXPECT_NEAR(p.elevation_cosine_at(h, up, false), above, 1e-15);
        EXPECT_NEAR(p.elevation_cosine_at(h, down, true), below, 1e-15);
        EXPECT_NEAR(up, std::sqrt(offset), 1e-6);
        EXPECT_NEAR(down, std::sqrt(offset), 1e-6);
      }
    }
  }
}

TEST(HillaireTables, ASunAndItsCoordinateAreTheSame) {
  for (P p : planets()) {
    double previous = -1;
    for (double mu = -1; mu <= 1; mu += 1 / 64.0) {
      double x = p.table_sun_coordinate(mu);
      EXPECT_NEAR(p.sun_cosine_at(x), mu, 1e-12);
      EXPECT_GT(x, previous);
      previous = x;
    }
    EXPECT_EQ(p.table_sun_coordinate(-1), 0);
    EXPECT_EQ(p.table_sun_coordinate(1), 1);
  }
}

TEST(HillaireTables, AnAltitudeAndItsCoordinateAreTheSame) {
  for (P p : planets()) {
    double top = p.scene.thickness_km;
    for (double h : {0.0, 1e-4, 0.3, 0.5 * top, top}) {
      EXPECT_NEAR(p.altitude_at(p.table_altitude_coordinate(h)), h, 1e-12 * top);
    }
  }
}

/// Whether the planet stands between a point of a ray and the sun, by its position.
bool in_shadow(const P& p, const P::SunlitRay& ray, double t) {
  double radius = p.scene.planet_radius_km, r = radius + ray.altitude_km;
  double along = r * ray.mu_sun + t * ray.nu, squared = r * r + 2 * r * ray.mu * t + t * t;
  return along < 0 && squared - along * along < radius * radius;
}

TEST(HillaireTables, TheShadowedPartIsWhereThePlanetHidesTheSun) {
  int found = 0;
  for (P p : planets()) {
    for (double h : {0.002, 0.1, 0.9}) {
      for (double mu : {-0.9, -0.1, -0.01, 0.0, 0.02, 0.3, 1.0}) {
        for (double mu_sun : {-0.7, -0.2, -0.06, -0.01, 0.0, 0.1}) {
          for (double azimuth : {1.0, 0.9, 0.0, -0.5, -1.0}) {
            double altitude = h * p.scene.thickness_km;
            double sines = std::sqrt((1 - mu * mu) * (1 - mu_sun * mu_sun));
            auto ray = p.sunlit_ray(altitude, mu, p.meets_ground(altitude, mu), mu_sun,
                                    mu * mu_sun + sines * azimuth);
            auto part = p.shadow_over(ray);
            found += part.leave_km > part.enter_km && part.enter_km > 0;
            for (int i = 0; i < 200; ++i) {
              double t = (i + 0.5) / 200 * ray.length_km;
              bool expected = in_shadow(p, ray, t), close = false;
              for (double edge : {part.enter_km, part.leave_km}) {
                close = close || std::abs(t - edge) < 1e-6 * ray.length_km;
              }
              ASSERT_TRUE(close || expected == (t > part.enter_km && t < part.leave_km))
                  << "altitude " << altitude << " mu " << mu << " sun " << mu_sun << " t " << t;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(found, 100);
}

TEST(HillaireTables, PanelsAddUpToTheColumnsOfTheirRay) {
  Problem problem = make_problem(read_scene(json::object()), {440, 550, 680});
  P p = pack<double>(problem);
  for (double h : {0.0, 0.5, 10.0, 90.0}) {
    for (double mu : {-0.9, -0.1, -0.02, 0.0, 0.1, 1.0}) {
      bool ground = p.meets_ground(h, mu);
      auto ray = p.sunlit_ray(h, mu, ground, -0.05, -0.03);
      auto panels = p.panels_along(ray, p.shadow_over(ray), 48, 1.2);
      double column[P::MEDIA_SIZE] = {}, expected[P::MEDIA_SIZE];
      glm::dvec4 density[P::MEDIA_SIZE], column_to[P::MEDIA_SIZE];
      for (int i = 0; i < p.number_of(panels); ++i) {
        p.pass_panel(ray, p.panel_of(panels, i), column, density, column_to);
        for (int c = 0; c < p.EXPONENTIALS; ++c) EXPECT_LE(column_to[c][3], column[c] + 1e-9);
      }
      p.columns_along(h, mu, ray.length_km, expected);
      for (int c = 0; c < p.MEDIA; ++c) {
        // A tent has kinks, which no smooth rule follows.
        double bound = c < p.EXPONENTIALS ? 1e-4 : 1e-2;
        EXPECT_NEAR(column[c], expected[c], bound * expected[c] + 1e-4)
            << "altitude " << h << " mu " << mu << " constituent " << c;
      }
    }
  }
}

/// Air that does not absorb, of a vertical optical depth, over a black or a white ground.
P white_air(double depth, double albedo) {
  json air = {{"type", "particles"},
              {"profile", {{"type", "exponential"}, {"scale_height_km", 8}}},
              {"optical_depth", depth},
              {"single_scattering_albedo", 1},
              {"phase", {{"type", "henyey_greenstein"}, {"g", 0}}}};
  json document = {
      {"planet", {{"ground_albedo", albedo}}},
      {"atmosphere",
       {{"constituents",
         {{"air", nullptr}, {"aerosol", nullptr}, {"ozone", nullptr}, {"white", air}}}}}};
  return with_optical_depths(pack<double>(make_problem(read_scene(document), {550})),
                             {128, 32});
}

struct SecondOrder {
  double radiance = 0, lost = 0, ground = 0;
};

SecondOrder second_order(P& p, double h, double mu_sun, int directions) {
  glm::dvec4 radiance[P::GROUPS_SIZE] = {}, lost[P::GROUPS_SIZE] = {},
             ground[P::GROUPS_SIZE] = {};
  for (int i = 0; i < directions; ++i) {
    double mu = p.lattice_cosine(i, directions);
    double sines = std::sqrt((1 - mu * mu) * (1 - mu_sun * mu_sun));
    double nu = mu * mu_sun + sines * std::cos(p.lattice_azimuth(i));
    p.add_second_order(p.sunlit_ray(h, mu, p.meets_ground(h, mu), mu_sun, nu), 20, 8, radiance,
                       lost, ground);
  }
  return {radiance[0].x / directions, lost[0].x / directions, ground[0].x / directions};
}

TEST(HillaireSeries, ConvergesBecauseEveryWayLosesSomething) {
  for (double depth : {0.01, 0.3, 3.0, 30.0}) {
    P p = white_air(depth, 1);
    for (double h : {0.0, 1.0, 20.0, 100.0}) {
      SecondOrder found = second_order(p, h, 0.5, 64);
      EXPECT_GT(found.lost, 0) << "depth " << depth << " altitude " << h;
      EXPECT_LE(found.lost, 1 + 1e-12);
      EXPECT_LE(found.ground, found.lost);
      EXPECT_GE(found.radiance, 0);
    }
  }
}

TEST(HillaireSeries, LosesWhatDoesNotScatter) {
  // From the ground, half of all ways end at once; the others lose exp(-depth / mu), whose mean
  // over the hemisphere in flat air is the exponential integral E2.
  double depth = 0.5, e2 = 0;
  for (int i = 0; i < 100000; ++i) e2 += std::exp(-depth / ((i + 0.5) / 100000)) / 100000;
  P p = white_air(depth, 0);
  p.scene.planet_radius_km = 1e6;
  p.optical_depths.clear();
  p = with_optical_depths(p, {128, 32});
  EXPECT_NEAR(second_order(p, 0, 1, 1024).lost, 0.5 + 0.5 * e2, 1e-3);
}

TEST(HillaireSeries, OfSomeTermsIsTheirSum) {
  P p = planet(6360, 100);
  glm::dvec4 lost(1, 0.8, 0.3, 0.01);
  glm::dvec4 sum(0), term(1);
  for (int terms = 0; terms < 6; ++terms) {
    for (int w = 0; w < 4; ++w)
      EXPECT_NEAR(p.series(lost, terms)[w], sum[w], 1e-12 + 1e-12 * sum[w]);
    sum += term;
    term *= 1.0 - lost;
  }
  for (int w = 0; w < 4; ++w) EXPECT_NEAR(p.series(lost, -1)[w], 1 / lost[w], 1e-12 / lost[w]);
}

TEST(HillaireForwardPeak, IsTheShareOfTheMeanCosine) {
  Problem problem = make_problem(read_scene(json::object()), {550});
  double g = 0.76, cornette_shanks = 3 * g * (4 + g * g) / (5 * (2 + g * g));
  Problem scaled = hillaire::without_forward_peak(problem, 0.5);
  for (std::size_t m = 0; m < problem.media.size(); ++m) {
    double before = problem.media[m].scattering_per_km[0];
    double peak = problem.media[m].name == "aerosol" ? 0.5 * cornette_shanks : 0;
    EXPECT_NEAR(scaled.media[m].scattering_per_km[0], before * (1 - peak), 1e-4 * before);
    EXPECT_EQ(scaled.media[m].absorption_per_km, problem.media[m].absorption_per_km);
  }
}

}  // namespace
}  // namespace cyanometer
