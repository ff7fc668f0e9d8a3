// A scene's constituents as curves agree with each other and with closed forms.
#include "engine/physics/curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/optics/phase.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

constexpr double degree = std::numbers::pi / 180;

double trapezoids(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += 0.5 * (x[i] - x[i - 1]) * (y[i] + y[i - 1]);
  return sum;
}

const ConstituentCurves& named(const Curves& curves, const std::string& name) {
  for (const auto& each : curves.constituents) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

/// Mie spheres, a tent and both a Henyey-Greenstein and a Rayleigh phase.
Scene mixed_scene() {
  return read_scene(
      {{"atmosphere",
        {{"constituents",
          {{"dust",
            {{"type", "particles"},
             {"optical_depth", {{"value", 0.3}, {"at_nm", 550}}},
             {"phase",
              {{"type", "mie"},
               {"radius_um", 0.2},
               {"geometric_sigma", 1.6},
               {"refractive_index", {1.5, 0.01}}}},
             {"profile", {{"type", "exponential"}, {"scale_height_km", 3}}}}},
           {"cloud",
            {{"type", "particles"},
             {"scattering_per_km", 0.05},
             {"absorption_per_km", 0.01},
             {"phase", {{"type", "henyey_greenstein"}, {"g", 0.6}}},
             {"profile", {{"type", "tent"}, {"centre_km", 9}, {"half_width_km", 4}}}}}}}}}});
}

TEST(Curves, EveryPhaseIntegratesToOne) {
  const Curves curves = constituent_curves(mixed_scene());
  std::vector<double> angles;
  for (const double angle : curves.angle_deg) angles.push_back(angle * degree);
  for (const auto& each : curves.constituents) {
    EXPECT_EQ(each.phase.empty(), each.name == "ozone");
    for (const auto& phase : each.phase) {
      EXPECT_NEAR(sphere_integral(angles, phase), 1, 0.01) << each.name;
    }
  }
}

TEST(Curves, TheOpticalDepthIsTheIntegralOfWhatIsDrawn) {
  const Curves curves = constituent_curves(mixed_scene());
  for (const auto& each : curves.constituents) {
    const double column = trapezoids(curves.altitude_km, each.density);
    for (std::size_t w = 0; w < curves.wavelengths_nm.size(); w += 7) {
      const double extinction = each.scattering_per_km[w] + each.absorption_per_km[w];
      EXPECT_NEAR(each.optical_depth[w], column * extinction, 0.02 * each.optical_depth[w])
          << each.name;
    }
  }
}

TEST(Curves, AreClosedFormsWhereThereAreSome) {
  const Curves curves = constituent_curves(mixed_scene());
  const auto& cloud = named(curves, "cloud");
  const auto& air = named(curves, "air");
  const double g = 0.6;
  for (std::size_t a = 0; a < curves.angle_deg.size(); a += 10) {
    const double mu = std::cos(curves.angle_deg[a] * degree);
    const double henyey_greenstein =
        (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * mu, 1.5));
    EXPECT_NEAR(cloud.phase[0][a], henyey_greenstein, 1e-9 * henyey_greenstein);
    // With air's depolarisation: (1 + 3 gamma) + (1 - gamma) cos^2, within 5 % of 1 + cos^2.
    EXPECT_NEAR(air.phase[0][a], 3 / (16 * std::numbers::pi) * (1 + mu * mu),
                0.05 * air.phase[0][a]);
  }
  for (std::size_t h = 0; h < curves.altitude_km.size(); h += 20) {
    EXPECT_NEAR(air.density[h], std::exp(-curves.altitude_km[h] / 8), 1e-12);
    EXPECT_NEAR(cloud.density[h], std::max(0.0, 1 - std::abs(curves.altitude_km[h] - 9) / 4),
                1e-12);
  }
}

TEST(Curves, AVisibilityComesBack) {
  const Curves curves =
      constituent_curves(read_scene({{"atmosphere",
                                      {{"constituents",
                                        {{"fog",
                                          {{"type", "particles"},
                                           {"visibility_km", 7},
                                           {"profile", {{"type", "uniform"}}}}}}}}}}));
  EXPECT_NEAR(named(curves, "fog").visibility_km.value(), 7, 1e-9);
}

TEST(Curves, FollowTheScenesOwnWavelengths) {
  const Curves curves =
      constituent_curves(read_scene({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                                     {"planet", {{"ground_albedo", {0.1, 0.2, 0.3}}}}}));
  EXPECT_EQ(curves.wavelengths_nm, (std::vector<double>{680, 550, 440}));
  EXPECT_EQ(curves.phase_wavelengths_nm, (std::vector<double>{440, 550, 680}));
  const auto& air = named(curves, "air");
  EXPECT_LT(air.scattering_per_km[0], air.scattering_per_km[2]);
}

}  // namespace
}  // namespace cyanometer
