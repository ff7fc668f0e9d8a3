#include "engine/accuracy/ingredients.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/accuracy/without_wavelength.h"
#include "engine/scene/document.h"
#include "tests/device.h"
#include "tests/surface/testing.h"

namespace cyanometer {
namespace {

using nlohmann::json;

std::map<std::string, Worth> explained(const json& more) {
  json document{{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                {"method", {{"max_error", 0.3}}},  // plans are quick where little is asked
                {"image", {{"width", 64}, {"height", 36}}}};
  document.update(more, true);
  std::map<std::string, Worth> found;
  for (const Worth& worth : explain(device(), read_scene(document))) found[worth.name] = worth;
  return found;
}

/// Clear air, and a matter that is next to nothing. What is left out has kernels of its own,
/// which are the same for both and compiled the sooner the fewer constituents there are.
const json few_constituents{{"constituents",
                             {{"aerosol", nullptr},
                              {"order_2",
                               {{"type", "absorber"},
                                {"absorption_per_km", 1e-9},
                                {"profile", {{"type", "uniform"}}}}}}}};

const std::map<std::string, Worth>& noon() {
  static const auto found =
      explained({{"preset", "earth_noon"}, {"atmosphere", few_constituents}});
  return found;
}

const std::map<std::string, Worth>& twilight() {
  static const auto found =
      explained({{"preset", "earth_twilight"}, {"atmosphere", few_constituents}});
  return found;
}

TEST(Explain, OzoneIsLittleAtNoonAndMuchInTwilight) {
  EXPECT_LT(noon().at("ozone").error, 0.05);
  EXPECT_GT(twilight().at("ozone").error, 4 * noon().at("ozone").error);
  EXPECT_GT(twilight().at("ozone").error, 0.1);
}

TEST(Explain, WhatIsOpticallyNothingIsWorthNothing) {
  const Worth& nothing = noon().at("constituent.order_2");
  EXPECT_LT(nothing.error, 1e-5);
  EXPECT_LT(*nothing.ciede2000, 0.5);
}

TEST(Explain, AirIsWorthMostByDay) {
  EXPECT_GT(noon().at("air").error, 0.3);
  EXPECT_GT(noon().at("air").error, noon().at("ozone").error);
}

TEST(Explain, OrdersAreWorthLessAndLess) {
  for (const auto* found : {&noon(), &twilight()}) {
    double before = found->at("multiple_scattering").error;
    for (int order = 2; order <= 6; ++order) {
      auto at = found->find("order_" + std::to_string(order));
      if (at == found->end()) {
        EXPECT_LT(before, 1e-3);
        break;
      }
      EXPECT_LT(at->second.error, before * 1.000001) << order;
      before = at->second.error;
    }
  }
}

TEST(Explain, CurvatureMattersAtLowSun) {
  EXPECT_GT(twilight().at("curvature").error, 0.3);
  EXPECT_GT(twilight().at("curvature").error, 3 * noon().at("curvature").error);
}

TEST(Explain, ASunAsNearIsAsBrightOverAFlatGround) {
  auto found = explained({{"sun", {{"distance_km", 30000}, {"elevation_deg", 60}}},
                          {"method", {{"scattering_orders", 1}}}});
  auto parallel =
      explained({{"sun", {{"elevation_deg", 60}}}, {"method", {{"scattering_orders", 1}}}});
  EXPECT_LT(found.at("curvature").error, 2 * parallel.at("curvature").error + 0.02);
}

/// Of ground seen from 20 km above it.
double worth_of_ground(const json& planet) {
  return explained(
             {{"planet", planet},
              {"sun", {{"elevation_deg", 50}, {"azimuth_deg", 180}}},
              {"camera", {{"altitude_km", 20}, {"pitch_deg", -40}, {"heading_deg", 180}}},
              {"atmosphere", {{"constituents", {{"aerosol", nullptr}, {"ozone", nullptr}}}}},
              {"method", {{"scattering_orders", 1}}}})
      .at("ground")
      .error;
}

json world(double albedo, const json& more) {
  json surface{{"type", "procedural"}};
  for (const char* matter : {"sea", "plants", "sand", "rock", "ice"}) surface[matter] = albedo;
  surface.update(more);
  return {{"surface", surface}};
}

TEST(Explain, GroundOfOneAlbedoIsWorthTheSameByAnyWay) {
  const double uniform = worth_of_ground({{"ground_albedo", 0.3}});
  EXPECT_GT(uniform, 0.2);
  EXPECT_NEAR(worth_of_ground(world(0.3, {{"sea_fraction", 0}})), uniform, 0.02 * uniform);
  surface_testing::Maps maps;
  maps.write("grey.exr", surface_testing::grey_map(0.3));
  EXPECT_NEAR(worth_of_ground({{"surface", {{"type", "map"}, {"albedo", "grey.exr"}}}}),
              uniform, 0.02 * uniform);
}

TEST(Explain, ASeaIsWorthWhatItMirrors) {
  const json sea{{"sea_fraction", 1}, {"ice_latitude_deg", 90}};
  EXPECT_GT(worth_of_ground(world(0, sea)), 0.05);
}

TEST(Explain, BlackGroundIsWorthNothingAndItsHeightsStay) {
  EXPECT_LT(worth_of_ground(world(0, {{"sea_fraction", 0}, {"relief_km", 15}})), 1e-6);
}

TEST(Explain, GivenWavelengthsOfAColourAreLeftOutByPlace) {
  auto found = explained(
      {{"method", {{"scattering_orders", 1}}},
       {"spectrum", {{"wavelengths_nm", {640, 590, 545, 500, 440}}, {"colour", "cie"}}},
       {"planet", {{"ground_albedo", {0.3, 0.3, 0.2, 0.1, 0.1}}}}});
  for (int place = 1; place <= 5; ++place) {
    const Worth& worth = found.at("wavelength_" + std::to_string(place));
    EXPECT_GT(worth.error, 0);
    EXPECT_GE(worth.ms_saved, 0);
  }
  EXPECT_FALSE(found.contains("wavelength_6"));
  EXPECT_FALSE(found.contains("multiple_scattering"));
  EXPECT_FALSE(found.contains("order_2"));
}

TEST(Explain, OneMoreWavelengthIsWorthLessTheMoreThereAre) {
  auto found = explained({{"method", {{"scattering_orders", 1}, {"max_error", 0.02}}},
                          {"spectrum", {{"wavelengths_nm", "auto"}, {"colour", "cie"}}}});
  ASSERT_TRUE(found.contains("wavelength_4"));
  ASSERT_TRUE(found.contains("wavelength_6"));
  EXPECT_LT(found.at("wavelength_6").error, found.at("wavelength_4").error);
}

TEST(Explain, IsGivenUpWhenNobodyWaits) {
  Watch watch;
  int looks = 0;
  watch.gone = [&] { return ++looks > 3; };
  EXPECT_THROW(explain(device(), read_scene({{"preset", "earth_noon"}}), watch), Cancelled);
}

TEST(Explain, ItsProgressEndsAtOrBelowTheWhole) {
  Watch watch;
  double last = 0;
  watch.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
  };
  explain(device(),
          read_scene({{"method", {{"scattering_orders", 1}}},
                      {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                      {"image", {{"width", 32}, {"height", 18}}}}),
          watch);
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(WithoutWavelength, EverySpectrumByWavelengthLosesItsValue) {
  Scene scene = read_scene(
      {{"spectrum", {{"wavelengths_nm", {640, 545, 440}}, {"colour", "channels"}}},
       {"planet", {{"ground_albedo", {0.3, 0.2, 0.1}}}},
       {"sun", {{"irradiance", {3, 2, 1}}}},
       {"atmosphere",
        {{"constituents",
          {{"air", {{"type", "molecules"}, {"scattering_per_km", {0.3, 0.2, 0.1}}}},
           {"gas",
            {{"type", "molecules"},
             {"refractive_index", {1.3, 1.2, 1.1}},
             {"pressure_pa", 1e4},
             {"temperature_k", 200},
             {"profile", {{"type", "uniform"}}}}},
           {"aerosol",
            {{"scattering_per_km", {0.3, 0.2, 0.1}}, {"absorption_per_km", {0.3, 0.2, 0.1}}}},
           {"haze",
            {{"type", "particles"},
             {"optical_depth", {0.3, 0.2, 0.1}},
             {"single_scattering_albedo", {0.3, 0.2, 0.1}},
             {"phase", {{"type", "henyey_greenstein"}, {"g", 0.5}}},
             {"profile", {{"type", "uniform"}}}}},
           {"ozone", {{"absorption_per_km", {0.3, 0.2, 0.1}}}}}}}}});
  for (std::size_t index : {0, 1, 2}) {
    json given = canonical(scene), less = canonical(without_wavelength(scene, index));
    int shortened = 0;
    std::function<void(const json&, const json&)> check = [&](const json& a, const json& b) {
      if (a.is_array() && a.size() == 3 && a[0].is_number()) {
        json expected = a;
        expected.erase(index);
        EXPECT_EQ(b, expected);
        ++shortened;
      } else if (a.is_object()) {
        for (const auto& [name, value] : a.items()) {
          if (b.contains(name)) check(value, b[name]);
        }
      }
    };
    check(given, less);
    EXPECT_EQ(shortened, 10);  // with the wavelengths themselves
  }
}

}  // namespace
}  // namespace cyanometer
