#include "engine/optics/legendre.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/gauss_legendre.h"
#include "engine/optics/phase.h"

namespace cyanometer {
namespace {

using std::numbers::pi;

/// chi_l of a function of the cosine, by quadrature.
template <class Function>
std::vector<double> by_quadrature(const Function& phase, int degree) {
  GaussRule rule = gauss_legendre(200);
  std::vector<double> chi(degree + 1, 0.0);
  for (int i = 0; i < 200; ++i) {
    double mu = 2 * rule.nodes[i] - 1, before = 0, p = 1;
    for (int l = 0; l <= degree; ++l) {
      chi[l] += 4 * pi * rule.weights[i] * phase(mu) * p;
      double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
      before = p;
      p = next;
    }
  }
  return chi;
}

double henyey_greenstein(double g, double mu) {
  return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * mu, 1.5));
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t l = 0; l < a.size(); ++l) EXPECT_NEAR(a[l], b[l], tolerance) << "l " << l;
}

TEST(LegendreCoefficients, OfRayleighScatteringAreThoseOfItsFunction) {
  for (double gamma : {0.0, 0.014, 0.1}) {
    auto phase = [&](double mu) {
      return 3 / (16 * pi * (1 + 2 * gamma)) * ((1 + 3 * gamma) + (1 - gamma) * mu * mu);
    };
    expect_near(rayleigh_coefficients(gamma, 6), by_quadrature(phase, 6), 1e-13);
  }
  EXPECT_DOUBLE_EQ(rayleigh_coefficients(0, 2)[2], 0.1);
}

TEST(LegendreCoefficients, OfHenyeyAndGreensteinArePowersOfG) {
  for (double g : {-0.5, 0.0, 0.76, 0.85}) {
    expect_near(henyey_greenstein_coefficients(g, 30),
                by_quadrature([&](double mu) { return henyey_greenstein(g, mu); }, 30), 1e-10);
  }
}

TEST(LegendreCoefficients, SumUpToTheFunctionThatTheyAreOf) {
  for (double g : {-0.5, 0.0, 0.7}) {
    for (double cosine : {-1.0, -0.3, 0.6, 1.0}) {
      double expected = (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
      EXPECT_NEAR(legendre_sum(henyey_greenstein_coefficients(g, 150), cosine), expected,
                  1e-9 * expected);
    }
  }
  EXPECT_EQ(legendre_sum({}, 0.5), 0);
}

TEST(LegendreCoefficients, OfCornetteAndShanksAreThoseOfItsFunction) {
  for (double g : {-0.5, 0.0, 0.76, 0.85}) {
    auto phase = [&](double mu) {
      return 1.5 * (1 + mu * mu) / (2 + g * g) * henyey_greenstein(g, mu);
    };
    expect_near(cornette_shanks_coefficients(g, 30), by_quadrature(phase, 30), 1e-10);
  }
}

TEST(LegendreCoefficients, OfATableAreThoseOfTheFunctionThatWasTabulated) {
  std::vector<double> angle, values;
  for (int i = 0; i <= 1800; ++i) {
    angle.push_back(pi * i / 1800);
    values.push_back(henyey_greenstein(0.8, std::cos(angle.back())));
  }
  expect_near(tabulated_coefficients(angle, {normalised_phase(angle, values)}, 60)[0],
              henyey_greenstein_coefficients(0.8, 60), 1e-5);
}

TEST(LegendreCoefficients, OfSeveralTablesAreThoseOfEach) {
  std::vector<double> angle{0, 0.02, 0.3, 1.1, 2.0, pi};
  std::vector<double> sharp{900, 40, 3, 0.1, 0.02, 0.3}, zero{0, 0.1, 0, 2, 0, 0.4};
  auto both = tabulated_coefficients(angle, {sharp, zero}, 40);
  expect_near(both[0], tabulated_coefficients(angle, {sharp}, 40)[0], 1e-7);
  expect_near(both[1], tabulated_coefficients(angle, {zero}, 40)[0], 1e-7);
}

TEST(LegendreCoefficients, BeginWithOneForAnyNormalisedTable) {
  std::vector<double> angle{0, 0.3, 1.1, 2.0, pi}, values{3, 0, 0.2, 0.1, 0.4};
  EXPECT_NEAR(tabulated_coefficients(angle, {normalised_phase(angle, values)}, 4)[0][0], 1,
              1e-7);
}

}  // namespace
}  // namespace cyanometer
