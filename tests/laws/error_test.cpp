#include "engine/accuracy/error.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cyanometer
