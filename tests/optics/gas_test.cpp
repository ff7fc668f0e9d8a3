#include "engine/optics/gas.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cyanometer {
namespace {

constexpr std::array names{"air", "co2", "n2", "h2", "he", "ch4"};
constexpr double standard_density = 101325 / (1.380649e-23 * 288.15);  // per m^3

double cross_section_cm2(const char* gas, double nm) {
  const double per_km = molecular_scattering_per_km(refractive_index(gas, nm),
                                                    king_factor(gas, nm), 101325, 288.15, nm);
  return per_km / 1000 / standard_density * 1e4;
}

// The nominal example of a widespread tutorial on skies: 8 pi^3 (n^2 - 1)^2 / (3 N l^4) with
// n = 1.00029 and N = 2.504e25, per metre at 680, 550 and 440 nm. Here N_s is 2.5469e25 and the
// form is that of Lorentz and Lorenz; at equal N the forms differ by 0.04 %.
TEST(Molecules, AgreeWithTheNominalCoefficients) {
  const double n = 1.00029, density = 2.504e25;
  const std::array nm{680.0, 550.0, 440.0}, nominal{5.1967e-6, 1.2143e-5, 2.9645e-5};
  for (std::size_t i = 0; i < 3; ++i) {
    const double simple = 8 * std::pow(std::numbers::pi, 3) * std::pow(n * n - 1, 2) /
                          (3 * density * std::pow(nm[i] * 1e-9, 4));
    EXPECT_NEAR(simple / nominal[i], 1, 1e-4);
    const double ours = molecular_scattering_per_km(n, 1, 101325, 288.15, nm[i]) / 1000;
    EXPECT_NEAR(ours * standard_density / density / nominal[i], 1, 5e-4);
  }
}

TEST(Molecules, ScatterInProportionToPressureAndInverselyToTemperature) {
  const auto scattering = [](double pressure_pa, double temperature_k) {
    return molecular_scattering_per_km(1.0003, 1.05, pressure_pa, temperature_k, 500);
  };
  const double base = scattering(50000, 250);
  EXPECT_DOUBLE_EQ(scattering(100000, 250), 2 * base);
  EXPECT_DOUBLE_EQ(scattering(50000, 500), base / 2);
  EXPECT_EQ(scattering(0, 250), 0);
}

// Bodhaine et al. 1999, J. Atmos. Oceanic Technol. 16, 1854, eq. 29: dry air with 360 ppm of
// CO2.
TEST(Molecules, CrossSectionOfAirAgreesWithBodhaine) {
  for (double nm = 250; nm <= 850; nm += 50) {
    const double l2 = nm * nm * 1e-6;
    const double published = 1e-28 * (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) /
                             (1 + 0.0027059889 / l2 - 85.968563 * l2);
    EXPECT_NEAR(cross_section_cm2("air", nm) / published, 1, 0.002) << nm;
  }
}

// Bucholtz 1995, Appl. Opt. 34, 2765, eq. 8 and table 3: a fit of his own cross-sections.
TEST(Molecules, CrossSectionOfAirAgreesWithBucholtz) {
  for (double nm : {300.0, 400.0, 500.0, 600.0, 800.0, 1000.0}) {
    const double l = nm / 1000;
    const double published =
        nm <= 500 ? 3.01577e-28 * std::pow(l, -(3.55212 + 1.35579 * l + 0.11563 / l))
                  : 4.01061e-28 * std::pow(l, -(3.99668 + 0.00110298 * l + 0.0271393 / l));
    EXPECT_NEAR(cross_section_cm2("air", nm) / published, 1, 0.01) << nm;
  }
}

// Measured by cavity ring-down: (5.10 +- 0.24)e-27 cm^2 at 532.2 nm [Sneep and Ubachs 2005,
// JQSRT 92, 293].
TEST(Molecules, CrossSectionOfNitrogenAgreesWithCavityRingDown) {
  EXPECT_NEAR(cross_section_cm2("n2", 532.2), 5.10e-27, 0.24e-27);
}

// At long wavelengths n - 1 is 2 pi N a, a the static polarisability: of helium 1.38376 atomic
// units (CODATA), of hydrogen 5.414 [Kolos and Wolniewicz 1967], of methane 16.5 [Olney et al.
// 1997].
TEST(Molecules, IndicesApproachTheStaticPolarisability) {
  constexpr double bohr3 = 1.4818471e-31;  // m^3
  const auto limit = [](double atomic_units) {
    return 2 * std::numbers::pi * standard_density * atomic_units * bohr3;
  };
  EXPECT_NEAR((refractive_index("he", 5000) - 1) / limit(1.38376), 1, 0.005);
  EXPECT_NEAR((refractive_index("h2", 5000) - 1) / limit(5.414), 1, 0.01);
}

// Kaye and Laby, Tables of Physical and Chemical Constants: 589.3 nm, 0 degrees and 101325 Pa.
TEST(Molecules, IndicesAgreeWithTheSodiumLine) {
  constexpr double to_288_k = 273.15 / 288.15;
  EXPECT_NEAR((refractive_index("air", 589.3) - 1) / to_288_k, 2.92e-4, 1e-6);
  EXPECT_NEAR((refractive_index("co2", 589.3) - 1) / to_288_k, 4.49e-4, 2e-6);
  EXPECT_NEAR((refractive_index("n2", 589.3) - 1) / to_288_k, 2.99e-4, 2e-6);
  EXPECT_NEAR((refractive_index("he", 589.3) - 1) / to_288_k, 3.5e-5, 1e-6);
  EXPECT_NEAR((refractive_index("ch4", 589.3) - 1) / to_288_k, 4.44e-4, 3e-6);
}

TEST(Molecules, AreFiniteAtEveryWavelengthAllowed) {
  for (const char* gas : names)
    for (double nm = 10; nm <= 5000; nm *= 1.01) {
      const double sigma = cross_section_cm2(gas, nm);
      EXPECT_TRUE(std::isfinite(sigma) && sigma > 0) << gas << nm;
      EXPECT_GE(king_factor(gas, nm), 1);
    }
}

TEST(Molecules, DisperseWithoutJumps) {
  for (const char* gas : names)
    for (double nm = 300; nm <= 1500; nm += 1) {
      const double before = refractive_index(gas, nm - 0.5) - 1;
      EXPECT_NEAR((refractive_index(gas, nm + 0.5) - 1) / before, 1, 2e-3) << gas << nm;
      EXPECT_LE(refractive_index(gas, nm + 0.5) - 1, before * (1 + 1e-5)) << gas << nm;
    }
}

// Bucholtz 1995, table 1: gamma of air is 1.442e-2 at 550 nm.
TEST(Molecules, DepolariseLikeAir) {
  EXPECT_NEAR(depolarisation_gamma(king_factor("air", 550)), 1.442e-2, 3e-4);
  EXPECT_GT(king_factor("air", 300), king_factor("air", 550));
  EXPECT_EQ(depolarisation_gamma(1), 0);
}

TEST(Molecules, OtherNamesAreRefused) {
  EXPECT_THROW(refractive_index("xenon", 500), std::out_of_range);
  EXPECT_THROW(king_factor("", 500), std::out_of_range);
}

}  // namespace
}  // namespace cyanometer
