// Tests of random results: deviations from what is expected, in standard errors.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace cyanometer {

/// Independent deviations, each divided by its stated standard error.
struct Deviations {
  std::vector<double> z;

  void add(double found, double expected, double standard_error) {
    z.push_back((found - expected) / standard_error);
  }

  double mean() const {
    double sum = 0;
    for (double x : z) sum += x;
    return sum / static_cast<double>(z.size());
  }
  double mean_square() const {
    double sum = 0;
    for (double x : z) sum += x * x;
    return sum / static_cast<double>(z.size());
  }
};

/// Expects what results without bias and with true standard errors show in 999 of 1000 runs:
/// the deviations' mean within 3.3 of its standard errors of 0, and their squares' (chi-square
/// over its degrees of freedom) within 3.3 of theirs of 1. `excess_kurtosis` is that of the
/// deviations: standard errors that are themselves found from n slices make it 6 / (n - 5), and
/// their mean square (n - 1) / (n - 3). Standard errors that are bounds may be too large by
/// `slack`.
inline void expect_normal(const Deviations& d, int slices, double slack = 0.15) {
  double n = static_cast<double>(d.z.size());
  double expected = (slices - 1.0) / (slices - 3.0), kurtosis = 6.0 / (slices - 5.0);
  double spread = 3.3 * expected * std::sqrt((2 + kurtosis) / n);
  std::printf("%zu deviations: mean %.3f (within %.3f), mean square %.3f (of %.3f +- %.3f)\n",
              d.z.size(), d.mean(), 3.3 * std::sqrt(expected / n), d.mean_square(), expected,
              spread);
  EXPECT_LT(std::abs(d.mean()), 3.3 * std::sqrt(expected / n));
  EXPECT_LT(d.mean_square(), expected + spread);
  EXPECT_GT(d.mean_square(), (1 - slack) * expected - spread);
}

}  // namespace cyanometer
