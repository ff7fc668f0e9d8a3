#include "engine/optics/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cyanometer {
namespace {

/// Midpoint rule over a density given as a function.
template <class Function>
double sum(double top_km, Function density) {
  constexpr int steps = 200000;
  double total = 0;
  for (int i = 0; i < steps; ++i) total += density((i + 0.5) * top_km / steps);
  return total * top_km / steps;
}

TEST(Column, OfAnExponentialIsItsScaleHeightButForTheTop) {
  EXPECT_DOUBLE_EQ(column_km(ExponentialProfile{8}, 1e6), 8);
  EXPECT_NEAR(column_km(ExponentialProfile{8}, 10),
              sum(10, [](double h) { return std::exp(-h / 8); }), 1e-9);
  EXPECT_NEAR(column_km(ExponentialProfile{1e9}, 100), 100, 1e-4);
}

TEST(Column, OfATentIsCutByGroundAndTop) {
  EXPECT_DOUBLE_EQ(column_km(TentProfile{25, 15}, 100), 15);
  for (const TentProfile& tent :
       {TentProfile{25, 15}, TentProfile{5, 15}, TentProfile{0, 10}, TentProfile{58, 15},
        TentProfile{70, 15}, TentProfile{60, 5}, TentProfile{30, 200}})
    EXPECT_NEAR(column_km(tent, 60),
                sum(60,
                    [&](double h) {
                      return std::max(0.0,
                                      1 - std::abs(h - tent.centre_km) / tent.half_width_km);
                    }),
                1e-6);
  EXPECT_EQ(column_km(TentProfile{200, 15}, 100), 0);
}

TEST(Column, OfAQuadraticIsAThirdAndOfAUniformAll) {
  EXPECT_DOUBLE_EQ(column_km(QuadraticProfile{}, 60), 20);
  EXPECT_DOUBLE_EQ(column_km(UniformProfile{}, 60), 60);
}

TEST(Column, OfATableIsExact) {
  // Two samples of an exponential are the exponential.
  EXPECT_NEAR(column_km(TableProfile{{0, 80}, {3, 3 * std::exp(-10)}}, 80),
              column_km(ExponentialProfile{8}, 80), 1e-12);
  // Constant below, linear next to a zero, nothing above.
  EXPECT_DOUBLE_EQ(column_km(TableProfile{{10, 20, 30}, {5, 5, 0}}, 100), 10 + 10 + 5);
  // Cut by the top, in the middle of a segment and below the first sample.
  EXPECT_NEAR(column_km(TableProfile{{0, 80}, {1, std::exp(-10)}}, 13),
              column_km(ExponentialProfile{8}, 13), 1e-12);
  EXPECT_DOUBLE_EQ(column_km(TableProfile{{10, 20}, {1, 1}}, 4), 4);
  // Samples under the ground count for what they say above it.
  EXPECT_DOUBLE_EQ(column_km(TableProfile{{-10, 10}, {0, 2}}, 100), 7.5);
}

TEST(Column, OfAnEmptyTableIsNothing) {
  EXPECT_EQ(column_km(TableProfile{{0, 10}, {0, 0}}, 100), 0);
}

TEST(Profiles, AreDividedByTheirMaximum) {
  const Profile table = normalised(TableProfile{{0, 10, 20}, {2, 8, 4}});
  EXPECT_EQ(std::get<TableProfile>(table).density, (std::vector<double>{0.25, 1, 0.5}));
  EXPECT_EQ(normalised(ExponentialProfile{3}), Profile(ExponentialProfile{3}));
  EXPECT_DOUBLE_EQ(column_km(table, 100), column_km(TableProfile{{0, 10, 20}, {2, 8, 4}}, 100));
}

}  // namespace
}  // namespace cyanometer
