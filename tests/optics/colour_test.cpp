#include "engine/optics/colour.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "engine/optics/sunlight.h"

namespace cyanometer {
namespace {

Triple colour_of(double (*spectrum)(double)) {
  Triple xyz{};
  for (double l = 360; l <= 830; l += 1)
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += spectrum(l) * colour_matching(l)[c];
  return xyz;
}

void expect_chromaticity(const Triple& xyz, double x, double y, double tolerance) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  EXPECT_NEAR(xyz[0] / sum, x, tolerance);
  EXPECT_NEAR(xyz[1] / sum, y, tolerance);
}

TEST(Colour, EqualEnergyIsWhite) {
  // CIE 015:2018: the sums of the table over 5 nm are 21.371 each.
  const Triple xyz = colour_of([](double) { return 1.0; });
  for (double sum : xyz) EXPECT_NEAR(sum / 5, 21.371, 0.01);
}

// CIE 015:2018: illuminant A, a Planckian radiator of 2855.5 K, is at (0.44758, 0.40745).
TEST(Colour, IlluminantAIsWhereTheCiePutsIt) {
  expect_chromaticity(colour_of([](double l) { return planck(2855.54, l); }), 0.44758, 0.40745,
                      1e-4);
}

// Sunlight above the air is a little bluer than 5772 K: about 5900 K, (0.323, 0.333).
TEST(Colour, SunlightAboveTheAirIsWhite) {
  expect_chromaticity(colour_of(measured_sunlight), 0.323, 0.333, 0.003);
}

// ITU-R BT.709-6 and IEC 61966-2-1: matrices to four digits.
TEST(Colour, Rec709IsTheStandards) {
  const Matrix published{0.4124, 0.3576, 0.1805, 0.2126, 0.7152,
                         0.0722, 0.0193, 0.1192, 0.9505};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(xyz_from_rec709()[i], published[i], 1e-4);
  const Matrix identity = rec709_from_xyz() * xyz_from_rec709();
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(identity[i], i % 4 == 0 ? 1 : 0, 1e-14);
}

TEST(Colour, AdaptationMakesTheWhiteWhite) {
  const Triple sun = colour_of(measured_sunlight);
  const Triple white = adaptation_to_d65(sun) * (rec709_from_xyz() * sun);
  EXPECT_NEAR(white[0] / white[1], 1, 1e-12);
  EXPECT_NEAR(white[2] / white[1], 1, 1e-12);
  // The luminance of the white itself is kept.
  EXPECT_NEAR((xyz_from_rec709() * white)[1] / sun[1], 1, 1e-12);
}

TEST(Colour, AdaptationFromD65IsNone) {
  const Matrix m = adaptation_to_d65(xyz_from_rec709() * Triple{1, 1, 1});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(m[i], i % 4 == 0 ? 1 : 0, 1e-12);
}

// Lindbloom: the Bradford matrix from A (1.09850, 1, 0.35585) to D65 (0.95047, 1, 1.08883), in
// XYZ.
TEST(Colour, AdaptationIsBradfords) {
  const Matrix published{0.8446965, -0.1179225, 0.3948108,  -0.1366303, 1.1041226,
                         0.1291718, 0.0798489,  -0.1348999, 3.1924009};
  const Matrix ours =
      xyz_from_rec709() * adaptation_to_d65({1.09850, 1, 0.35585}) * rec709_from_xyz();
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(ours[i], published[i], 1e-3);
}

TEST(Colour, NothingAdaptsToADarkOrAMonochromaticLight) {
  EXPECT_THROW(adaptation_to_d65({0, 0, 0}), std::domain_error);
  EXPECT_THROW(adaptation_to_d65(colour_matching(400)), std::domain_error);
}

}  // namespace
}  // namespace cyanometer
