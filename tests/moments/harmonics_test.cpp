// The formulas of shaders/methods/moments.glsl by their own laws.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "engine/gauss_legendre.h"
#include "engine/methods/moments/grid.h"
#include "engine/physics/pack.h"

namespace cyanometer {
namespace {

using P = Physics<double>;
constexpr double pi = std::numbers::pi;
constexpr int degree = 8;

glm::dvec3 direction(double mu, double azimuth) {
  double sine = std::sqrt(1 - mu * mu);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

/// sum over m of norm_lm P_l^(m)(mu) P_l^(m)(mu_s) c_m
double addition(P& p, int l, double mu, double mu_s, double nu) {
  double a[P::MOST_MOMENTS], b[P::MOST_MOMENTS], c[P::MOST_DEGREE + 1], sum = 0;
  p.zenith_polynomials(mu, degree, a);
  p.zenith_polynomials(mu_s, degree, b);
  p.azimuth_terms(mu, mu_s, nu, degree, c);
  for (int m = 0; m <= l; ++m) {
    int n = p.moment_index(l, m);
    sum += p.harmonic_norm(l, m) * a[n] * b[n] * c[m];
  }
  return sum;
}

TEST(MomentHarmonics, ObeyTheAdditionTheoremAlsoWithTheSunInTheZenithAndTheNadir) {
  P p;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> cosine(-1, 1), angle(0, 2 * pi);
  for (int i = 0; i < 200; ++i) {
    double mu = cosine(random), mu_s = i % 10 == 0 ? 1 : i % 10 == 1 ? -1 : cosine(random);
    double nu = glm::dot(direction(mu, angle(random)), direction(mu_s, 0));
    double legendre[P::MOST_TERMS];
    p.legendre_polynomials(nu, degree, legendre);
    for (int l = 0; l <= degree; ++l) {
      EXPECT_NEAR(addition(p, l, mu, mu_s, nu), (2 * l + 1) / (4 * pi) * legendre[l], 1e-11);
    }
  }
}

TEST(MomentHarmonics, GiveBackARadianceOfTheirDegree) {
  P p;
  double mu_s = 0.3;
  glm::dvec3 sun = direction(mu_s, 0), lobe = direction(-0.5, 0);
  auto radiance = [&](const glm::dvec3& d) {
    return std::pow(1 + glm::dot(d, lobe), 5) + std::pow(glm::dot(d, sun), 3);
  };
  double moment[P::MOST_MOMENTS] = {}, q[P::MOST_MOMENTS], c[P::MOST_DEGREE + 1];
  GaussRule rule = gauss_legendre(10);
  constexpr int azimuths = 12;
  for (int j = 0; j < 10; ++j) {
    for (int a = 0; a < azimuths; ++a) {
      double mu = 2 * rule.nodes[j] - 1;
      glm::dvec3 d = direction(mu, pi * (a + 0.5) / azimuths);
      p.zenith_polynomials(mu, degree, q);
      p.azimuth_terms(mu, mu_s, glm::dot(d, sun), degree, c);
      for (int l = 0; l <= degree; ++l) {
        for (int m = 0; m <= l; ++m) {
          int n = p.moment_index(l, m);
          moment[n] += radiance(d) * rule.weights[j] * 4 * pi / azimuths * q[n] * c[m] *
                       p.harmonic_norm(l, m) / std::pow(1 - mu_s * mu_s, m);
        }
      }
    }
  }
  for (double mu : {-0.9, -0.2, 0.4, 1.0}) {
    for (double azimuth : {0.0, 1.0, 2.5, pi}) {
      glm::dvec3 d = direction(mu, azimuth);
      p.zenith_polynomials(mu, degree, q);
      p.azimuth_terms(mu, mu_s, glm::dot(d, sun), degree, c);
      double sum = 0;
      for (int l = 0; l <= degree; ++l) {
        for (int m = 0; m <= l; ++m)
          sum += moment[p.moment_index(l, m)] * q[p.moment_index(l, m)] * c[m];
      }
      EXPECT_NEAR(sum, radiance(d), 1e-10 * 32);
    }
  }
}

Problem planet(double radius_km, double thickness_km, double scale_height_km,
               double sun_distance_km) {
  Problem problem;
  problem.planet_radius_km = radius_km;
  problem.thickness_km = thickness_km;
  problem.wavelengths_nm = {550};
  problem.ground_albedo = {0.3};
  problem.limb_darkening_exponent = {0};
  problem.sun_direction = {0, 0, 1};
  problem.sun_distance_km = sun_distance_km;
  problem.media.push_back(
      {"air", ExponentialProfile{scale_height_km}, {0.01}, {0}, RayleighPhase{{0}}});
  return problem;
}

std::vector<Problem> planets() {
  return {planet(6360, 100, 8, 0), planet(6360, 200, 8, 0),   planet(400, 60, 10, 0),
          planet(50, 20, 3, 0),    planet(6360, 1000, 60, 0), planet(6360, 100, 8, 20000)};
}

TEST(MomentGrid, FindsItsOwnNodes) {
  for (const Problem& problem : planets()) {
    P p = pack<double>(problem);
    P::MomentGrid grid = moment_grid<double>(problem, 8, 16);
    for (int i = 0; i < 8; ++i) {
      double h = p.altitude_of_node(grid, i);
      EXPECT_NEAR(p.node_of_altitude(grid, h), i, 1e-9);
      P::SunRange range = p.sun_range(grid, h);
      double last = -2;
      for (int s = 0; s < 16; ++s) {
        double mu_s = p.sun_of_node(grid, range, s);
        EXPECT_GT(mu_s, last);
        EXPECT_NEAR(p.node_of_sun(grid, range, mu_s), s, 1e-9);
        last = mu_s;
      }
      EXPECT_NEAR(last, P::MOST_SUN_COSINE, 1e-9);
    }
  }
}

TEST(MomentGrid, HasTwoNodesOnEitherSideOfTheShadowsEdgeAtEveryAltitude) {
  for (const Problem& problem : planets()) {
    P p = pack<double>(problem);
    P::MomentGrid grid = moment_grid<double>(problem, 8, 16);
    for (double share : {0.0, 0.1, 0.5, 1.0}) {
      double h = share * problem.thickness_km;
      // Of parallel light at -dip; of a near sun earlier by the planet's angle from there.
      double parallax = std::asin(grid.parallax_sine);
      double edge = std::sin(parallax - std::asin(p.dip_sine(h)));
      double node = p.node_of_sun(grid, p.sun_range(grid, h), edge);
      EXPECT_GT(node, 2);
      EXPECT_LT(node, 13);
    }
  }
}

TEST(MomentRays, HaveTheLengthThatTheirNodesStandFor) {
  P p = pack<double>(planet(6360, 100, 8, 0));
  GaussRule rule = gauss_legendre(6);
  for (double h : {0.0, 3.0, 50.0}) {
    for (double mu : {-0.9, -0.05, 0.0, 0.3, 1.0}) {
      bool ground = p.meets_ground(h, mu);
      double length = ground ? p.distance_to_ground(h, mu) : p.distance_to_top(h, mu), sum = 0;
      P::Cuts cuts = p.cuts_of(h, mu, length);
      for (int k = 0; k < 6; ++k) {
        P::RayNode node = p.ray_node(cuts, rule.nodes[k], rule.weights[k]);
        EXPECT_GE(node.t_km, 0);
        EXPECT_LE(node.t_km, length);
        sum += node.width_km;
      }
      EXPECT_NEAR(sum, length, 1e-9 * length);
    }
  }
}

TEST(MomentSky, FindsTheDirectionsOfItsNodes) {
  for (double altitude : {0.0, 0.002, 5.0, 99.0, 400.0, 36000.0}) {
    Problem problem = planet(6360, 100, 8, 0);
    problem.camera.altitude_km = altitude;
    P p = pack<double>(problem);
    glm::dvec2 forward(0.6, 0.8);
    for (bool ground : {false, true}) {
      if (ground && altitude == 0) continue;  // the ground is underfoot, whatever the direction
      for (double share : {0.01, 0.2, 0.5, 0.8, 0.99}) {
        for (double azimuth : {0.01, 1.0, 3.1}) {
          glm::dvec3 d = p.direction_of_share(share, ground, azimuth, forward);
          EXPECT_NEAR(glm::length(d), 1, 1e-12);
          EXPECT_EQ(p.path_from_camera(d).meets_ground, ground);
          EXPECT_TRUE(p.meets_planet(p.path_from_camera(d)));
          EXPECT_NEAR(p.elevation_share(d, ground), share, 1e-6);
          EXPECT_NEAR(p.azimuth_from(forward, d), azimuth, 1e-6);
        }
      }
    }
  }
}

TEST(MomentInterpolation, IsExactForCubicsAndKeepsToTheRangeOfACliff) {
  P p;
  glm::dvec4 cubic[4],
      cliff[4] = {glm::dvec4(0), glm::dvec4(0), glm::dvec4(30), glm::dvec4(30)};
  for (double node : {0.2, 1.5, 3.9, 6.8}) {
    P::CubicTaps taps = p.cubic_taps(node, 8);
    auto f = [](double x) { return 1 + x * (2 + x * (-1 + 0.3 * x)); };
    for (int tap = 0; tap < 4; ++tap) cubic[tap] = glm::dvec4(f(taps.first + tap));
    EXPECT_NEAR(p.cubic_sum(cubic, taps).x, f(node), 1e-11);
    EXPECT_GE(p.limited_sum(cliff, taps).x, -0.25);
    EXPECT_LE(p.limited_sum(cliff, taps).x, 30.25);
  }
}

TEST(MomentInterpolation, IsNotBentByACliffBeyondItsInterval) {
  P p;
  for (double depth : {5.0, 30.0, 3000.0}) {
    glm::dvec4 falls[4] = {glm::dvec4(-depth), glm::dvec4(0), glm::dvec4(1), glm::dvec4(2)};
    glm::dvec4 rises[4] = {glm::dvec4(2), glm::dvec4(1), glm::dvec4(0), glm::dvec4(-depth)};
    for (double t = 0; t < 0.95; t += 0.1) {
      EXPECT_NEAR(p.limited_sum(falls, p.cubic_taps(3 + t, 8)).x, t, 0.04);
      EXPECT_NEAR(p.limited_sum(rises, p.cubic_taps(3 + t, 8)).x, 1 - t, 0.04);
    }
    for (int node = 0; node < 8; ++node) {
      P::CubicTaps taps = p.cubic_taps(node, 8);
      EXPECT_NEAR(p.limited_sum(falls, taps).x, falls[node - taps.first].x, 1e-9);
    }
  }
}

TEST(MomentAzimuths, HaveASeriesThatIsExactForWhatTheirPointsTellApart) {
  P p;
  for (int points : {1, 2, 3}) {
    auto f = [&](double x) {
      return points == 1 ? 3 : points == 2 ? 3 - x : 3 - x + 4 * x * x;
    };
    glm::dvec3 series(0);
    for (int i = 0; i < points; ++i) {
      double x = p.azimuth_point(i, points);
      series += f(x) * p.chebyshev_shares(x, points);
    }
    auto v = [&](int i) { return glm::dvec4(series[i]); };
    for (double x : {-1.0, -0.3, 0.8}) {
      EXPECT_NEAR(p.chebyshev_sum(v(0), v(1), v(2), x).x, f(x), 1e-12) << points;
    }
  }
}

TEST(MomentAzimuths, ChangeTheirNumberWithoutAJump) {
  P p;
  auto light_at = [&](double spacings, double x) {
    P::AzimuthRule rule = p.azimuth_rule(spacings);
    glm::dvec3 series(0);
    for (int i = 0; i < rule.points + rule.more; ++i) {
      P::AzimuthSample sample = p.azimuth_sample(rule, i);
      series += std::exp(2 * sample.x) * sample.shares;
    }
    return series[0] + series[1] * x + series[2] * (2 * x * x - 1);
  };
  for (double x : {-1.0, -0.3, 0.8}) {
    double before = light_at(0.1, x);
    for (double spacings = 0.1; spacings < 1.3; spacings += 1e-5) {
      double now = light_at(spacings, x);
      EXPECT_NEAR(now, before, 5e-3) << spacings;
      before = now;
    }
  }
  EXPECT_EQ(p.azimuth_rule(0.2).points, 1);
  EXPECT_EQ(p.azimuth_rule(0.5).points, 2);
  EXPECT_EQ(p.azimuth_rule(1.1).points, 3);
}

TEST(MomentAzimuths, AreTracedOneByOneWhereTheirLightFallsByPowersOfTen) {
  P p;
  EXPECT_EQ(p.share_of_each_azimuth(0), 0);
  EXPECT_EQ(p.share_of_each_azimuth(2.5 / 1.06), 0);
  EXPECT_NEAR(p.share_of_each_azimuth(2.5 / 1.025), 0.5, 1e-9);
  EXPECT_EQ(p.share_of_each_azimuth(2.6), 1);
}

TEST(MomentAzimuths, InterpolateWithWeightsOfThePolynomialThroughAllPoints) {
  P p;
  for (int points = 1; points <= 8; ++points) {
    for (double x : {-1.0, -0.35, 0.6}) {
      double sum = 0;
      for (int i = 0; i < points; ++i) {
        double point = p.azimuth_point(i, points);
        sum += std::pow(point, points - 1) * p.chebyshev_weight(point, points, x);
      }
      EXPECT_NEAR(sum, std::pow(x, points - 1), 1e-12) << points;
    }
  }
}

}  // namespace
}  // namespace cyanometer
