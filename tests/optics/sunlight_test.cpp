#include "engine/optics/sunlight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/optics/colour.h"

namespace cyanometer {
namespace {

template <class Function>
double integral(double from, double to, double step, Function f) {
  double sum = 0;
  for (double l = from + step / 2; l < to; l += step) sum += f(l) * step;
  return sum;
}

// ASTM E490-00a: 1366.1 W m^-2 in all, 99.56 % of it below 5 um.
TEST(Sunlight, MeasuredTotalIsTheSolarConstant) {
  EXPECT_NEAR(integral(10, 5000, 0.5, measured_sunlight), 1366.1 - 6.1, 1);
}

// 133.1 klx outside the air is the luminous solar constant of ASTM E490 [Darula et al. 2005].
TEST(Sunlight, MeasuredIlluminanceIsKnown) {
  const double lux = luminous_efficacy * integral(360, 830, 1, [](double l) {
                       return measured_sunlight(l) * colour_matching(l)[1];
                     });
  EXPECT_NEAR(lux, 133.1e3, 0.7e3);
}

TEST(Sunlight, MeasuredIsPositiveAndSmallInTheFarUltraviolet) {
  for (double l = 10; l <= 5000; l += 1) EXPECT_GT(measured_sunlight(l), 0);
  EXPECT_LT(measured_sunlight(50), 1e-4);
}

TEST(Sunlight, BlackBodiesFollowWienAndStefanBoltzmann) {
  for (double kelvin : {1000.0, 5772.0, 12000.0}) {
    const double peak_nm = 2897771.955 / kelvin;
    EXPECT_GT(planck(kelvin, peak_nm), planck(kelvin, peak_nm * 1.01));
    EXPECT_GT(planck(kelvin, peak_nm), planck(kelvin, peak_nm / 1.01));
    const double radiance = integral(peak_nm / 20, peak_nm * 60, peak_nm / 1000,
                                     [&](double l) { return planck(kelvin, l); });
    EXPECT_NEAR(radiance * M_PI / (5.670374419e-8 * std::pow(kelvin, 4)), 1, 3e-4);
  }
}

TEST(Sunlight, TheSunsBlackBodyHasTheSunsTotalAndAHotterOneMore) {
  const auto total = [](double kelvin) {
    return integral(20, 100000, 5, [&](double l) { return blackbody_sunlight(kelvin, l); });
  };
  EXPECT_NEAR(total(5772), 1361, 0.5);
  EXPECT_NEAR(total(2 * 5772) / total(5772), 16, 0.02);
}

// The photosphere is seen to depths from 5000 K (Fraunhofer lines) to 6500 K (1.6 um).
TEST(Sunlight, TheSunsBlackBodyResemblesTheMeasuredOne) {
  for (double l = 450; l <= 2500; l += 25)
    EXPECT_NEAR(blackbody_sunlight(5772, l) / measured_sunlight(l), 1, 0.2) << l;
}

// Hestroffer and Magnan 1998, eq. 4: 0.508 at 550 nm.
TEST(Sunlight, LimbDarkensMoreInTheBlue) {
  EXPECT_NEAR(limb_darkening_exponent(550), 0.508, 0.001);
  EXPECT_GT(limb_darkening_exponent(450), limb_darkening_exponent(650));
  EXPECT_EQ(limb_darkening_exponent(10), limb_darkening_exponent(416));
  EXPECT_EQ(limb_darkening_exponent(5000), limb_darkening_exponent(1099));
}

}  // namespace
}  // namespace cyanometer
