#include "engine/optics/ozone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cyanometer {
namespace {

// At the mercury line of 253.65 nm the agreed value is 1.1329e-17 cm^2 at room temperature
// [Hodges et al. 2019, Metrologia 56, 034001]; colder ozone absorbs within 1 % of it.
TEST(Ozone, HartleyBandAgreesAtTheMercuryLine) {
  EXPECT_NEAR(ozone_cross_section_m2(253.65) / 1.1329e-21, 1, 0.02);
}

// Anderson and Mauersberger 1992, Geophys. Res. Lett. 19, 933: 5.18e-21 cm^2 at 604.6 nm, the
// peak of the Chappuis band; bins of 10 nm flatten it.
TEST(Ozone, ChappuisBandAgreesAtItsPeak) {
  EXPECT_NEAR(ozone_cross_section_m2(604.6) / 5.18e-25, 1, 0.04);
}

TEST(Ozone, IsTransparentInTheVioletAndTheInfrared) {
  const double column = 300 * molecules_per_dobson_unit;
  EXPECT_LT(column * ozone_cross_section_m2(390), 1e-3);
  EXPECT_LT(column * ozone_cross_section_m2(900), 1e-3);
  EXPECT_EQ(ozone_cross_section_m2(5000), 0);
}

TEST(Ozone, KeepsOutTheUltraviolet) {
  const double column = 300 * molecules_per_dobson_unit;
  EXPECT_GT(column * ozone_cross_section_m2(280), 20);
  // Across the Huggins bands the cross-section falls tenfold every 15 to 20 nm.
  const double slope =
      std::log10(ozone_cross_section_m2(305) / ozone_cross_section_m2(340)) / 35;
  EXPECT_NEAR(1 / slope, 16, 3);
}

TEST(Ozone, IsFiniteAndContinuous) {
  double before = ozone_cross_section_m2(10);
  for (double nm = 10; nm <= 5000; nm += 0.1) {
    const double now = ozone_cross_section_m2(nm);
    EXPECT_TRUE(now >= 0 && now < 2e-21);
    EXPECT_NEAR(now, before, 0.12 * before + 1e-28) << nm;
    before = now;
  }
}

}  // namespace
}  // namespace cyanometer
