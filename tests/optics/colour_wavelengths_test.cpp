#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "engine/optics/colour.h"
#include "engine/optics/gas.h"
#include "engine/optics/ozone.h"
#include "engine/optics/sunlight.h"
#include "engine/problem.h"

namespace cyanometer {
namespace {

/// Light of a plane-parallel sky, a ground or the sun, radiance over irradiance up to a
/// constant.
struct Sky {
  double aerosol;         ///< optical depth at 550 nm
  double sun_air_mass;    ///< that sunlight has crossed
  double sun_ozone_mass;  ///< of 300 Dobson units
  double view_air_mass;   ///< 0: the ground, or the sun itself

  double operator()(double nm) const {
    const double air = molecular_scattering_per_km(refractive_index("air", nm),
                                                   king_factor("air", nm), 101325, 288.15, nm) *
                       8;
    const double haze = aerosol * std::pow(nm / 550, -1.3);
    const double ozone = 300 * molecules_per_dobson_unit * ozone_cross_section_m2(nm);
    const double sunlight = std::exp(-(air + haze) * sun_air_mass - ozone * sun_ozone_mass);
    if (view_air_mass == 0) return sunlight;
    return sunlight * (air + 0.3 * haze) / (air + haze) *
           -std::expm1(-(air + haze) * view_air_mass);
  }
};

std::vector<Sky> skies() {
  std::vector<Sky> all;
  for (double aerosol : {0.02, 0.1, 0.4})
    for (double sun : {1.0, 2.0, 5.0, 10.0, 20.0, 35.0})
      for (double view : {0.0, 1.0, 2.0, 5.0, 15.0, 38.0})
        all.push_back({aerosol, sun, sun, view});
  // Twilight: little air, much ozone.
  for (double ozone : {5.0, 15.0, 30.0, 45.0})
    for (double sun : {0.3, 1.0, 3.0, 8.0}) all.push_back({0, sun, ozone, 1e-3});
  return all;
}

Triple colour(const std::vector<double>& wavelengths_nm, const Sky& sky) {
  const Output output = make_output(Scene{}, wavelengths_nm);
  Triple xyz{};
  for (std::size_t w = 0; w < wavelengths_nm.size(); ++w)
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += output.xyz[c][w] * sky(wavelengths_nm[w]);
  return xyz;
}

double rms_error(const std::vector<double>& wavelengths_nm) {
  static const std::vector<Triple> truth = [] {
    std::vector<double> every_nm;
    for (double l = 360; l <= 830; ++l) every_nm.push_back(l);
    std::vector<Triple> colours;
    for (const Sky& sky : skies()) colours.push_back(colour(every_nm, sky));
    return colours;
  }();
  double sum = 0;
  const std::vector<Sky> all = skies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Triple ours = colour(wavelengths_nm, all[i]);
    for (std::size_t c = 0; c < 3; ++c) sum += std::pow(ours[c] / truth[i][c] - 1, 2);
  }
  return std::sqrt(sum / static_cast<double>(3 * all.size()));
}

TEST(ColourWavelengths, AscendWithinTheVisible) {
  for (int count = 3; count <= 64; ++count) {
    const auto wavelengths = colour_wavelengths(count);
    ASSERT_EQ(wavelengths.size(), static_cast<std::size_t>(count));
    EXPECT_GE(wavelengths.front(), 360);
    EXPECT_LE(wavelengths.back(), 830);
    for (int i = 1; i < count; ++i) EXPECT_GT(wavelengths[i], wavelengths[i - 1] + 0.5);
  }
}

TEST(ColourWavelengths, AreAsGoodAsDocumented) {
  const std::array<std::pair<int, double>, 8> documented{{{3, 0.33},
                                                          {4, 0.18},
                                                          {6, 0.08},
                                                          {8, 0.039},
                                                          {12, 0.017},
                                                          {16, 0.010},
                                                          {32, 0.0027},
                                                          {64, 0.0009}}};
  for (const auto& [count, error] : documented)
    EXPECT_LT(rms_error(colour_wavelengths(count)), error) << count;
}

TEST(ColourWavelengths, MoreAreBetter) {
  double before = 1;
  for (int count : {3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
    const double now = rms_error(colour_wavelengths(count));
    EXPECT_LT(now, 0.95 * before) << count;
    before = now;
  }
}

TEST(ColourWavelengths, BeatEvenSpacingTwofold) {
  for (int count : {4, 8, 16, 32}) {
    std::vector<double> even;
    for (int i = 0; i < count; ++i) even.push_back(400 + 290.0 * i / (count - 1));
    EXPECT_LT(rms_error(colour_wavelengths(count)), 0.5 * rms_error(even)) << count;
  }
}

}  // namespace
}  // namespace cyanometer
