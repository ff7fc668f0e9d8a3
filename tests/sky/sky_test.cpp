// The clear sky against what others measured: luminance, illuminance and chromaticity. Their
// air is not ours; the bounds are what its turbidity and the spread of the measurements
// explain.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/engine.h"
#include "engine/optics/colour.h"
#include "engine/problem.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

constexpr double degree = std::numbers::pi / 180;

nlohmann::json aerosol(double optical_depth) {
  using nlohmann::json;
  json depth{{"power_law", {{"value", optical_depth}, {"at_nm", 550}, {"exponent", -1.3}}}};
  return json{{"constituents", json{{"aerosol", json{{"optical_depth", depth}}}}}};
}

/// The `earth` preset with all orders, at wavelengths that colour needs.
Scene clear_sky(double sun_elevation_deg, double aerosol_optical_depth = 0.1) {
  using nlohmann::json;
  return read_scene(json{{"sun", json{{"elevation_deg", sun_elevation_deg}}},
                         {"camera", json{{"altitude_km", 0}}},
                         {"atmosphere", aerosol(aerosol_optical_depth)},
                         {"method", json{{"name", "moments"}}},
                         {"spectrum", json{{"wavelengths_nm", colour_wavelengths(12)}}}});
}

/// X, Y, Z of a spectral radiance in cd/m^2, or of an irradiance in lx.
Triple xyz(const Scene& scene, const std::vector<double>& spectrum) {
  const std::vector<double>& wavelengths = scene.spectrum.wavelengths_nm;
  Output output = make_output(scene, wavelengths);
  Triple sum{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t w = 0; w < wavelengths.size(); ++w) {
      sum[c] += output.white_luminance * output.xyz[c][w] * spectrum[w] / output.irradiance[w];
    }
  }
  return sum;
}

Radiances looked_at(const Scene& scene, const std::vector<Direction>& directions) {
  return device().radiance(scene, directions, true);
}

/// Direct illuminance normal to the beam, lx.
double direct_normal_lx(const Scene& scene, const Radiances& sky) {
  return xyz(scene, sky.irradiance->direct)[1] / std::sin(scene.sun.elevation_deg * degree);
}

/// Relative optical air mass [Kasten and Young 1989].
double air_mass(double elevation_deg) {
  return 1 / (std::sin(elevation_deg * degree) +
              0.50572 * std::pow(elevation_deg + 6.07995, -1.6364));
}

/// Illuminance turbidity of the direct beam [Navvab et al. 1984]: how many clean atmospheres,
/// whose luminous extinction per air mass is 0.1 / (1 + 0.0045 m) [Clear 1982], dim the sun as
/// much.
double turbidity(const Scene& scene, const Radiances& sky) {
  double m = air_mass(scene.sun.elevation_deg);
  double clean = 0.1 / (1 + 0.0045 * m);
  std::vector<double> outside = make_output(scene, scene.spectrum.wavelengths_nm).irradiance;
  return std::log(xyz(scene, outside)[1] / direct_normal_lx(scene, sky)) / (clean * m);
}

/// Zenith luminance over that of the regression over three years in San Francisco [Karayel et
/// al. 1984], kcd/m^2 at a turbidity and a sun.
double zenith_over_measured(double sun_elevation_deg, double aerosol_optical_depth) {
  Scene scene = clear_sky(sun_elevation_deg, aerosol_optical_depth);
  Radiances sky = looked_at(scene, {{90, 0}});
  double kcd = xyz(scene, sky.radiance[0])[1] / 1000, t = turbidity(scene, sky);
  double measured = (1.376 * t - 1.81) * std::tan(sun_elevation_deg * degree) + 0.38;
  std::printf("sun %2.0f deg, turbidity %.2f: zenith %.2f kcd/m^2, measured %.2f\n",
              sun_elevation_deg, t, kcd, measured);
  return kcd / measured;
}

TEST(ClearSky, HasTheMeasuredZenithLuminanceAtATurbidityOfThree) {
  for (double elevation : {15.0, 25.0, 35.0, 45.0, 55.0}) {
    EXPECT_NEAR(zenith_over_measured(elevation, 0.2), 1, 0.2) << elevation;
  }
}

TEST(ClearSky, HasAZenithThatBrightensWithTurbidityAboutAsMeasured) {
  // Towards the ends of the measured turbidities a straight line is less of a description, and
  // whose particles they were matters more.
  for (double elevation : {15.0, 30.0, 45.0}) {
    for (double depth : {0.1, 0.3}) {
      EXPECT_NEAR(zenith_over_measured(elevation, depth), 1, 0.35) << elevation;
    }
  }
}

TEST(ClearSky, GivesTheIlluminanceOfClearDays) {
  for (double elevation : {10.0, 20.0, 40.0, 60.0}) {
    Scene scene = clear_sky(elevation);
    Radiances sky = looked_at(scene, {{90, 0}});
    double diffuse = xyz(scene, sky.irradiance->diffuse_down)[1] / 1000;
    // Averages over American measurements [Gillette and Pierpoint 1982; IES 1984], klx.
    double measured_diffuse = 0.8 + 15.5 * std::sqrt(std::sin(elevation * degree));
    double direct = direct_normal_lx(scene, sky) / 1000;
    double measured_direct = 127.5 * std::exp(-0.21 * air_mass(elevation));
    std::printf("sun %2.0f deg: sky %.1f klx, measured %.1f; sun %.1f klx, measured %.1f\n",
                elevation, diffuse, measured_diffuse, direct, measured_direct);
    EXPECT_NEAR(diffuse, measured_diffuse, 0.3 * measured_diffuse) << elevation;
    EXPECT_NEAR(direct, measured_direct, 0.15 * measured_direct) << elevation;
  }
}

TEST(ClearSky, HasColoursNextToTheDaylightLocus) {
  // Of 1500 narrow-field spectra in Granada [Hernandez-Andres, Romero and Lee 2001] all are
  // close to the CIE locus y = -3 x^2 + 2.87 x - 0.275 [Judd et al. 1964], from 3800 K (x =
  // 0.39) to beyond any colour temperature (x = 0.24).
  double bluest = 1, reddest = 0, farthest = 0;
  for (double elevation : {20.0, 40.0, 60.0}) {
    Scene scene = clear_sky(elevation);
    std::vector<Direction> directions;
    for (double e : {5.0, 15.0, 30.0, 60.0, 90.0}) {
      for (double azimuth : {45.0, 90.0, 135.0, 180.0}) directions.push_back({e, azimuth});
    }
    Radiances sky = looked_at(scene, directions);
    for (const auto& spectrum : sky.radiance) {
      Triple colour = xyz(scene, spectrum);
      double sum = colour[0] + colour[1] + colour[2], x = colour[0] / sum, y = colour[1] / sum;
      double locus = -3 * x * x + 2.87 * x - 0.275;
      bluest = std::min(bluest, x);
      reddest = std::max(reddest, x);
      farthest = std::max(farthest, std::abs(y - locus));
    }
  }
  std::printf("x from %.3f to %.3f, y within %.3f of the daylight locus\n", bluest, reddest,
              farthest);
  EXPECT_GT(bluest, 0.23);
  EXPECT_LT(bluest, 0.26);
  EXPECT_LT(reddest, 0.39);
  EXPECT_LT(farthest, 0.015);
}

}  // namespace
}  // namespace cyanometer
