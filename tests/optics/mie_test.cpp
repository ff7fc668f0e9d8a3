#include "engine/optics/mie.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/attention.h"
#include "engine/engine.h"
#include "engine/optics/phase.h"

namespace cyanometer {
namespace {

using std::numbers::pi;

// Bohren and Huffman 1983, appendix A: a sphere of radius 0.525 um and index 1.55 at 632.8 nm.
TEST(Mie, AgreesWithTheExampleOfBohrenAndHuffman) {
  const MieSeries series = mie_series(2 * pi * 0.525 / 0.6328, 1.55);
  EXPECT_NEAR(extinction_efficiency(series), 3.10543, 1e-5);
  EXPECT_NEAR(scattering_efficiency(series), 3.10543, 1e-5);
  EXPECT_NEAR(asymmetry(series), 0.63314, 1e-5);
}

// Wiscombe 1979, NCAR/TN-140+STR, test cases of MIEV0.
TEST(Mie, AgreesWithWiscombe) {
  struct Case {
    std::complex<double> index;
    double size, extinction, scattering, asymmetry;
  };
  const Case cases[] = {
      {{0.75, 0}, 1000, 1.997908, 1.997908, 0.844944},
      {{1.5, 0}, 10, 2.881999, 2.881999, 0.742913},
      {{1.5, 0}, 100, 2.094388, 2.094388, 0.818246},
      {{1.5, 0}, 1000, 2.013945, 2.013945, 0.827882},
      {{1.33, 1e-5}, 1, 0.093952, 0.093923, 0.184517},
      {{1.33, 1e-5}, 100, 2.101321, 2.096594, 0.868959},
      {{1.33, 1e-5}, 10000, 2.004089, 1.723857, 0.907840},
      {{1.5, 1}, 1, 2.336321, 0.663454, 0.192136},
      {{1.5, 1}, 100, 2.097502, 1.283697, 0.850252},
      {{1.5, 1}, 10000, 2.004368, 1.236574, 0.846310},
      {{10, 10}, 1, 2.532993, 2.049405, -0.110664},
      {{10, 10}, 100, 2.071124, 1.836785, 0.556215},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::Message() << "index " << c.index << ", size " << c.size);
    const MieSeries series = mie_series(c.size, c.index);
    EXPECT_NEAR(extinction_efficiency(series), c.extinction, 2e-6);
    EXPECT_NEAR(scattering_efficiency(series), c.scattering, 2e-6);
    EXPECT_NEAR(asymmetry(series), c.asymmetry, 2e-6);
  }
}

TEST(Mie, SmallSpheresScatterLikeRayleigh) {
  for (double x : {1e-6, 1e-3, 0.02}) {
    const double m2 = 1.5 * 1.5;
    const double rayleigh = 8.0 / 3 * std::pow(x, 4) * std::pow((m2 - 1) / (m2 + 2), 2);
    const MieSeries series = mie_series(x, 1.5);
    EXPECT_NEAR(scattering_efficiency(series) / rayleigh, 1, x * x + 1e-9);
    const auto intensity = scattered_intensity(series, {1, 0, -1});
    EXPECT_NEAR(intensity[0] / intensity[1], 2, 4 * x);
    EXPECT_NEAR(intensity[2] / intensity[1], 2, 4 * x);
  }
}

TEST(Mie, SmallSphereSeriesMeetsTheRecurrence) {
  for (std::complex<double> m : {std::complex<double>(1.5, 0), {1.33, 1e-3}, {2, 1}}) {
    const MieSeries below = mie_series(0.003 * (1 - 1e-12), m), above = mie_series(0.003, m);
    EXPECT_NEAR(extinction_efficiency(below) / extinction_efficiency(above), 1, 1e-6);
    EXPECT_NEAR(scattering_efficiency(below) / scattering_efficiency(above), 1, 1e-6);
  }
}

TEST(Mie, LargeSpheresRemoveTwiceTheirShadow) {
  // The edge's correction is of the order of x^(-2/3) [van de Hulst 1957].
  for (double x : {300.0, 1000.0, 5000.0})
    EXPECT_NEAR(extinction_efficiency(mie_series(x, {1.5, 0.1})), 2, 3 * std::pow(x, -2.0 / 3));
}

TEST(Mie, ExtinctionFollowsFromTheForwardAmplitude) {
  // The optical theorem: Q_ext = 4 / x^2 Re S(0); |S(0)|^2 bounds it from above.
  for (double x : {0.5, 5.0, 50.0}) {
    const MieSeries series = mie_series(x, {1.5, 0.02});
    const double forward = std::sqrt(scattered_intensity(series, {1})[0]);
    EXPECT_LE(extinction_efficiency(series), 4 / (x * x) * forward * (1 + 1e-12));
  }
}

TEST(Mie, TransparentSpheresAbsorbNothingAndOthersSome) {
  for (double x : {0.001, 0.3, 4.0, 77.0, 1234.0}) {
    const MieSeries clear = mie_series(x, 1.4), dark = mie_series(x, {1.4, 0.1});
    EXPECT_NEAR(scattering_efficiency(clear) / extinction_efficiency(clear), 1, 1e-7);
    EXPECT_LT(scattering_efficiency(dark), extinction_efficiency(dark));
  }
}

TEST(Mie, IntensityOverTheSphereIsTheScatteringEfficiency) {
  for (double x : {0.005, 0.5, 5.0, 40.0}) {
    const MieSeries series = mie_series(x, {1.45, 0.01});
    std::vector<double> angles, cosines;
    for (int i = 0; i <= 20000; ++i) {
      angles.push_back(pi * i / 20000);
      cosines.push_back(std::cos(angles.back()));
    }
    const double integral = sphere_integral(angles, scattered_intensity(series, cosines));
    EXPECT_NEAR(integral / (pi * x * x * scattering_efficiency(series)), 1, 1e-5);
  }
}

TEST(Mie, AnglesOfTheTableResolveAnyCloud) {
  // What normalisation has to correct is what the angles miss; single sizes are the worst case.
  std::vector<double> cosines;
  for (double angle : mie_angles_rad()) cosines.push_back(std::cos(angle));
  for (double x : {1.0, 30.0, 300.0, 3000.0}) {
    const MieSeries series = mie_series(x, 1.33);
    const double integral =
        sphere_integral(mie_angles_rad(), scattered_intensity(series, cosines));
    EXPECT_NEAR(integral / (pi * x * x * scattering_efficiency(series)), 1, 0.05) << x;
  }
}

TEST(MieSizes, PhaseFunctionsIntegrateToOne) {
  for (const MieSpheres& spheres :
       {MieSpheres{0.1, 2, {1.5, 0.01}}, MieSpheres{10, 1.3, {1.33, 0}},
        MieSpheres{5, 1, {1.33, 0}}, MieSpheres{1, 4, {1.5, 0}}})
    for (const auto& phase : mie_optics(spheres, {700, 400}).phase)
      EXPECT_NEAR(sphere_integral(mie_angles_rad(), phase), 1, 1e-12);
}

TEST(MieSizes, ANarrowDistributionIsOneSize) {
  const auto one = mie_optics({0.2, 1, {1.5, 0.01}}, {550}),
             narrow = mie_optics({0.2, 1.002, {1.5, 0.01}}, {550});
  EXPECT_NEAR(narrow.extinction_um2[0] / one.extinction_um2[0], 1, 1e-3);
  EXPECT_NEAR(narrow.scattering_um2[0] / one.scattering_um2[0], 1, 1e-3);
  for (std::size_t j = 0; j < mie_angles_rad().size(); ++j)
    EXPECT_NEAR(narrow.phase[0][j] / one.phase[0][j], 1, 5e-3);
}

TEST(MieSizes, ANarrowDistributionOfLargeSpheresIsOneSize) {
  for (std::complex<double> m : {std::complex<double>(1.33, 0.01), {1.33, 0}}) {
    const auto one = mie_optics({50, 1, {m.real(), m.imag()}}, {400, 700});
    for (double sigma : {1.001, 1.005}) {
      const auto narrow = mie_optics({50, sigma, {m.real(), m.imag()}}, {400, 700});
      for (std::size_t w = 0; w < 2; ++w) {
        SCOPED_TRACE(testing::Message() << m << ", " << sigma << ", " << w);
        // Through clear spheres light interferes with light around them, by size.
        const double bound = m.imag() > 0 ? 1e-3 : 1e-2;
        EXPECT_NEAR(narrow.extinction_um2[w] / one.extinction_um2[w], 1, bound);
        EXPECT_NEAR(narrow.scattering_um2[w] / one.scattering_um2[w], 1, bound);
      }
    }
  }
}

TEST(MieSizes, MomentsOfTheLogNormalAreThoseOfItsFormula) {
  // Small spheres see the sixth moment, r^6 exp(18 ln^2 sigma) ...
  const double sigma = 1.3, log2 = std::log(sigma) * std::log(sigma);
  const auto small = mie_optics({0.001, sigma, {1.5, 0}}, {1000});
  const auto one = mie_optics({0.001, 1, {1.5, 0}}, {1000});
  EXPECT_NEAR(small.scattering_um2[0] / one.scattering_um2[0], std::exp(18 * log2),
              0.002 * std::exp(18 * log2));
  // ... and large ones twice the second, r^2 exp(2 ln^2 sigma).
  const auto large = mie_optics({30, sigma, {1.5, 0.1}}, {300});
  EXPECT_NEAR(large.extinction_um2[0] / (pi * 30 * 30 * std::exp(2 * log2)), 2, 0.04);
}

TEST(MieSizes, TheSameSpheresScatterAlikeWhereSizeOverWavelengthIsTheSame) {
  const auto near = mie_optics({0.3, 1.7, {1.5, 0.01}}, {500}),
             far = mie_optics({0.6, 1.7, {1.5, 0.01}}, {1000});
  EXPECT_NEAR(far.extinction_um2[0] / near.extinction_um2[0], 4, 1e-3);
}

TEST(MieSizes, WavelengthsDoNotDependOnTheirCompany) {
  const MieSpheres spheres{0.2, 1.8, {1.5, 0.01}};
  const auto alone = mie_optics(spheres, {550}),
             together = mie_optics(spheres, {400, 550, 1000});
  EXPECT_EQ(alone.extinction_um2[0], together.extinction_um2[1]);
  EXPECT_EQ(alone.phase[0], together.phase[1]);
}

TEST(MieSizes, ExtremesStayFinite) {
  for (const MieSpheres& s : {MieSpheres{1e-3, 1, {1.3, 0}}, MieSpheres{100, 10, {1.5, 0.01}},
                              MieSpheres{1000, 1, {1.33, 0}}, MieSpheres{1e-3, 1.0001, {3, 5}},
                              MieSpheres{0.1, 1.5, {1, 0.5}}}) {
    const auto optics = mie_optics(s, {10, 5000});
    for (std::size_t w = 0; w < 2; ++w) {
      EXPECT_TRUE(std::isfinite(optics.extinction_um2[w]) && optics.extinction_um2[w] > 0);
      EXPECT_LE(optics.scattering_um2[w], optics.extinction_um2[w] * (1 + 1e-9));
      for (double value : optics.phase[w]) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    }
  }
}

TEST(Mie, StopsWhereNobodyWaits) {
  const MieSpheres spheres;
  const auto solve = [&] { mie_optics(spheres, {450, 550, 650}); };
  Watch watch;
  int looks = 0;
  watch.gone = [&] { return ++looks >= 2; };
  {
    const Attention attention(watch);
    EXPECT_THROW(solve(), Cancelled);
    EXPECT_EQ(looks, 2);
    {
      const Watch other;
      const Attention within(other);
      EXPECT_NO_THROW(solve());
    }
    EXPECT_THROW(solve(), Cancelled);
  }
  EXPECT_NO_THROW(solve());
  EXPECT_EQ(looks, 3);
}

}  // namespace
}  // namespace cyanometer
