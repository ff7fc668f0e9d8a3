#include "engine/optics/phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cyanometer {
namespace {

using std::numbers::pi;

TEST(PhaseTable, OfAConstantIntegratesToTheSphere) {
  EXPECT_NEAR(sphere_integral({0, pi}, {1, 1}), 4 * pi, 1e-12);
  EXPECT_NEAR(sphere_integral({0, 1e-4, 0.5, pi}, {1, 1, 1, 1}), 4 * pi, 1e-12);
}

TEST(PhaseTable, IntegratesAsItIsInterpolated) {
  const std::vector<double> angles{0, 0.01, 0.4, 1.5, 2, pi}, values{50, 8, 1, 0, 0.2, 3};
  const auto interpolated = [&](double t) {
    std::size_t i = 1;
    while (angles[i] < t) ++i;
    const double s = (t - angles[i - 1]) / (angles[i] - angles[i - 1]);
    const double a = values[i - 1], b = values[i];
    return a > 0 && b > 0 ? a * std::pow(b / a, s) : a + s * (b - a);
  };
  double sum = 0;
  constexpr int steps = 1000000;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * pi / steps;
    sum += 2 * pi * interpolated(t) * std::sin(t) * pi / steps;
  }
  EXPECT_NEAR(sphere_integral(angles, values), sum, 1e-6 * sum);
}

TEST(PhaseTable, IsNormalisedToOne) {
  const std::vector<double> angles{0, 0.001, 0.3, 1, pi};
  const auto values = normalised_phase(angles, {1e9, 1e5, 3, 0, 1});
  EXPECT_NEAR(sphere_integral(angles, values), 1, 1e-12);
  EXPECT_EQ(normalised_phase({0, pi}, {0, 0}), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace cyanometer
