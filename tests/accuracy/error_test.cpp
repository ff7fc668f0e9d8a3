#include "engine/accuracy/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cyanometer {
namespace {

TEST(ErrorMeasure, OfEqualFramesIsZero) {
  ErrorMeasure measure = measure_error({{1, 2}, {3, 4}}, {{1, 2}, {3, 4}});
  EXPECT_EQ(measure.error, 0);
  EXPECT_EQ(measure.max, 0);
}

TEST(ErrorMeasure, IsRelativeToTheLargerValueAndAHundredthOfTheMedian) {
  // One channel, reference 1 everywhere: d = 0.1 / (1.1 + 0.01).
  ErrorMeasure measure = measure_error({{1.1}, {1.1}, {1.1}}, {{1}, {1}, {1}});
  EXPECT_NEAR(measure.error, 0.1 / 1.11, 1e-12);
  EXPECT_NEAR(measure.bias, 0.1 / 1.11, 1e-12);
}

TEST(ErrorMeasure, OfABlackFrameIsAlmostOne) {
  ErrorMeasure measure = measure_error({{0}, {0}}, {{2}, {2}});
  EXPECT_NEAR(measure.error, 2 / 2.02, 1e-12);
  EXPECT_LT(measure.bias, 0);
}

TEST(ErrorMeasure, DoesNotCountWhatIsBlackInBoth) {
  EXPECT_EQ(measure_error({{0}, {0}}, {{0}, {0}}).error, 0);
}

TEST(ErrorMeasure, SeesARareLargeErrorThroughItsPercentile) {
  std::vector<std::vector<double>> reference(100, {1.0}), values = reference;
  values[7][0] = values[8][0] = 0;  // 2 % of the pixels are lost
  ErrorMeasure measure = measure_error(values, reference);
  EXPECT_NEAR(measure.p99, 1 / 1.01, 1e-12);
  EXPECT_NEAR(measure.error, measure.p99 / 3, 1e-12);
}

/// Values that are off by `share` to either side of 1, judged against halves of some noise, as
/// often as there are seeds.
struct Trial {
  double error = 0;
  bool covered = false;
  Trial(unsigned seed, double share, double noise) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    std::vector<std::vector<double>> values, a, b;
    for (int i = 0; i < 512; ++i) {
      double off = share * gauss(random);
      values.push_back({1 + off, 1 - off});
      auto draw = [&] {
        return std::vector{1 + noise * gauss(random), 1 + noise * gauss(random)};
      };
      a.push_back(draw());
      b.push_back(draw());
    }
    EstimatedError estimate = measure_error(values, a, b);
    error = estimate.measure.error;
    double exact = share / 1.01;
    covered = estimate.low <= exact && exact <= estimate.high;
  }
};

TEST(EstimatedError, IsFreeOfTheReferencesNoise) {
  constexpr int trials = 100;
  double sum = 0;
  int covered = 0;
  for (unsigned seed = 0; seed < trials; ++seed) {
    Trial trial(seed, 0.01, 0.01);
    sum += trial.error * trial.error;
    covered += trial.covered;
  }
  // Against one noisy reference the rms would be 0.0123. That of one trial is known to some 5
  // %, the percentile counts one time in twenty.
  EXPECT_NEAR(std::sqrt(sum / trials), 0.01 / 1.01, 3e-4);
  // Of 100 intervals that cover in 95 % of cases, 88 do in all but a thousandth of cases.
  EXPECT_GE(covered, 88);
}

TEST(EstimatedError, SeesFarBelowTheReferencesNoise) {
  constexpr int trials = 50;
  double sum = 0;
  for (unsigned seed = 0; seed < trials; ++seed) sum += Trial(seed, 0.002, 0.01).error;
  // What is left of a noise of 0.007, of the mean of both halves, in 1024 values: its fourth
  // root of them in the rms, some 0.0015, and as much in a third of the percentile.
  EXPECT_LT(sum / trials, 0.003);
}

/// The night side of a planet: walks that found nothing decide nothing.
TEST(EstimatedError, KnowsNothingWhereBothEstimatesAreBlack) {
  const std::vector<std::vector<double>> dim(64, {1e-14, 1}), black(64, {0, 1});
  const EstimatedError blind = measure_error(dim, black, black);
  EXPECT_EQ(blind.low, 0);
  EXPECT_EQ(blind.high, 1);
  EXPECT_EQ(measure_error(black, black, black).high, 0);
}

TEST(EstimatedError, WithoutNoiseIsTheMeasureItself) {
  std::vector<std::vector<double>> reference{{1, 2}, {3, 1}, {2, 2}},
      values{{1.1, 2}, {2.5, 1}, {2, 3}};
  ErrorMeasure plain = measure_error(values, reference);
  EstimatedError estimate = measure_error(values, reference, reference);
  EXPECT_DOUBLE_EQ(estimate.measure.error, plain.error);
  EXPECT_DOUBLE_EQ(estimate.measure.bias, plain.bias);
  EXPECT_DOUBLE_EQ(estimate.measure.p99, plain.p99);
  EXPECT_DOUBLE_EQ(estimate.measure.max, plain.max);
}

}  // namespace
}  // namespace cyanometer
