#include "engine/optics/spectrum.h"

#include <gtest/gtest.h>

namespace cyanometer {
namespace {

TEST(Spectra, OfANumberAreTheSameEverywhere) {
  EXPECT_EQ(evaluate(Spectrum(0.3), {}, 10), 0.3);
  EXPECT_EQ(evaluate(Spectrum(0.3), {550}, 5000), 0.3);
}

TEST(Spectra, OfAnArrayBelongToTheScenesWavelengthsInTheirOrder) {
  const Spectrum array = PerWavelength{{1, 2, 4}};
  EXPECT_EQ(evaluate(array, {400, 500, 600}, 500), 2);
  EXPECT_EQ(evaluate(array, {680, 550, 440}, 680), 1);
  EXPECT_EQ(evaluate(array, {680, 550, 440}, 440), 4);
  EXPECT_DOUBLE_EQ(evaluate(array, {680, 550, 440}, 495), 3);
  EXPECT_EQ(evaluate(array, {680, 550, 440}, 300), 4);
  EXPECT_EQ(evaluate(Spectrum(PerWavelength{{7}}), {500}, 600), 7);
}

TEST(Spectra, OfAPowerLawFollowIt) {
  EXPECT_DOUBLE_EQ(evaluate(Spectrum(PowerLaw{2, 500, -4}), {}, 1000), 2.0 / 16);
}

TEST(Spectra, OfSamplesAreLinearBetweenAndConstantBeyond) {
  const Spectrum samples = SampledSpectrum{{400, 600}, {1, 3}};
  EXPECT_DOUBLE_EQ(evaluate(samples, {}, 450), 1.5);
  EXPECT_EQ(evaluate(samples, {}, 100), 1);
  EXPECT_EQ(evaluate(samples, {}, 900), 3);
}

}  // namespace
}  // namespace cyanometer
