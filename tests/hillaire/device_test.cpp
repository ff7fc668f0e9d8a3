// Hillaire's method on the device: against the adaptive integral in order one, against a random
// walk and the laws of energy in all orders, and against itself where its tables have seams.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/scene/document.h"
#include "tests/device.h"
#include "tests/oracle/scenes.h"

namespace cyanometer::oracle {
namespace {

using nlohmann::json;
constexpr double pi = std::numbers::pi;

Scene scene_of(json document, const json& options = json::object()) {
  document["method"] = {{"name", "hillaire"}};
  document["method"].update(options);
  document["spectrum"] = {{"wavelengths_nm", {680, 550, 440}}, {"colour", "channels"}};
  document["sun"]["irradiance"] = 1;
  return read_scene(document);
}

json earth(double altitude_km, double sun_elevation_deg) {
  return {{"camera", {{"altitude_km", altitude_km}}},
          {"sun", {{"elevation_deg", sun_elevation_deg}}}};
}

std::vector<std::vector<double>> radiance(const Scene& scene,
                                          const std::vector<Direction>& directions) {
  return device().radiance(scene, directions, false).radiance;
}

/// Directions that meet the planet, spread over elevation and azimuth.
std::vector<Direction> spread_directions(double altitude_km, int count) {
  double highest =
      altitude_km > 100 ? -glm::degrees(std::acos(6460 / (6360 + altitude_km))) : 90;
  std::vector<Direction> directions;
  for (int i = 0; i < count; ++i) {
    double elevation = -90 + (highest + 90) * (i + 0.5) / count;
    directions.push_back({elevation, std::fmod(137.50776 * i, 360)});
  }
  return directions;
}

double error_of_order_one(json document, json options, int count) {
  options["scattering_orders"] = 1;
  Scene scene = scene_of(document, options);
  std::vector<Direction> directions = spread_directions(scene.camera.altitude_km, count);
  Adaptive integral(pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm)), 1e-5);
  std::vector<std::vector<double>> exact;
  for (const Direction& d : directions) {
    Ray ray = integral.trace(towards(d.elevation_deg, d.azimuth_deg));
    std::vector<double>& values = exact.emplace_back();
    for (int w = 0; w < 3; ++w) values.push_back(ray.inscatter[w] + ray.ground[w]);
  }
  return measure_error(radiance(scene, directions), exact).error;
}

const json fine = {{"transmittance_cosines", 1024},
                   {"transmittance_altitudes", 512},
                   {"view_samples", 64},
                   {"sky_azimuths", 256},
                   {"sky_elevations", 384}};

TEST(Hillaire, OfOrderOneComesToTheAdaptiveIntegralAsTablesAndSamplesGrow) {
  struct Place {
    double altitude_km, sun_deg, usual, fine;
  };
  for (Place at :
       {Place{0.002, 40, 5e-3, 1e-3}, Place{0.002, 2, 1e-2, 2e-3}, Place{0.002, -4, 4e-2, 1e-2},
        Place{10, 20, 1e-2, 2e-3}, Place{400, 20, 1e-2, 3e-3}, Place{36000, 50, 1e-2, 3e-3}}) {
    json document = earth(at.altitude_km, at.sun_deg);
    double usual = error_of_order_one(document, json::object(), 40);
    double better = error_of_order_one(document, fine, 40);
    std::printf("altitude %g km, sun %g deg: %.1e, fine tables %.1e\n", at.altitude_km,
                at.sun_deg, usual, better);
    EXPECT_LT(usual, at.usual);
    EXPECT_LT(better, at.fine);
    EXPECT_LT(better, 0.7 * usual);
  }
}

TEST(Hillaire, OfOrderOneMarchedComesToTheAdaptiveIntegralInThickHazeToo) {
  json options = fine;
  options["march_pixels"] = 1;
  for (const char* preset : {"earth_dust", "earth_hazy", "mars", "earth_twilight"}) {
    json document = {{"preset", preset}, {"camera", {{"altitude_km", 0.002}}}};
    EXPECT_LT(error_of_order_one(document, options, 24), 3e-3) << preset;
  }
}

json evenly_scattering_air(double albedo) {
  json spectrum = {{"wavelengths_nm", {440, 550, 680}}, {"values", {0.0331, 0.0136, 0.0058}}};
  return {{"type", "particles"},
          {"profile", {{"type", "exponential"}, {"scale_height_km", 8}}},
          {"scattering_per_km", spectrum},
          {"absorption_per_km", (1 / albedo - 1) * 0.01},
          {"phase", {{"type", "henyey_greenstein"}, {"g", 0}}}};
}

json with_air(json document, const json& air) {
  document["atmosphere"]["constituents"] = {
      {"air", nullptr}, {"aerosol", nullptr}, {"ozone", nullptr}, {"even", air}};
  return document;
}

/// All orders in air that scatters evenly over black ground, by analogue random walks from the
/// camera that look at the sun from every vertex, in double. One wavelength of the first group.
double random_walks(const Scene& scene, const Direction& direction, int lane, int walks) {
  P p = pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm));
  double scattering = p.scattering(0, 0)[lane], extinction = p.extinction(0, 0)[lane];
  glm::dvec3 sun = p.sun_ray({0, 0, 0}, {0, 0, 0}).direction;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double sum = 0, column[P::MEDIA_SIZE];
  for (int walk = 0; walk < walks; ++walk) {
    glm::dvec3 x(0, 0, p.scene.planet_radius_km + p.scene.camera_altitude_km);
    glm::dvec3 to = towards(direction.elevation_deg, direction.azimuth_deg);
    for (int event = 0; event < 60; ++event) {
      // Woodcock tracking below the density of the ground.
      double r = glm::length(x);
      for (bool collided = false; !collided;) {
        x += to * (-std::log(1 - uniform(random)) / extinction);
        r = glm::length(x);
        double h = r - p.scene.planet_radius_km;
        if (h < 0 || h > p.scene.thickness_km) break;
        collided = uniform(random) < std::exp(-h / 8);
      }
      double h = r - p.scene.planet_radius_km;
      if (h < 0 || h > p.scene.thickness_km || uniform(random) > scattering / extinction) break;
      double mu_sun = glm::dot(x, sun) / r;
      if (!p.meets_ground(h, mu_sun)) {
        p.columns_to_top(h, mu_sun, column);
        sum += std::exp(-extinction * column[0]) / (4 * pi);
      }
      double z = 2 * uniform(random) - 1, a = 2 * pi * uniform(random),
             s = std::sqrt(1 - z * z);
      to = {s * std::cos(a), s * std::sin(a), z};
    }
  }
  return sum / walks;
}

TEST(Hillaire, IsWithinAFewPercentOfRandomWalksInAirThatScattersEvenly) {
  for (double sun : {40.0, 8.0}) {
    json document = with_air(earth(0.002, sun), evenly_scattering_air(0.95));
    document["planet"]["ground_albedo"] = 0;
    Scene scene = scene_of(document);
    std::vector<Direction> directions{{90, 0}, {30, 90}, {10, 180}};
    auto found = radiance(scene, directions);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      double expected = random_walks(scene, directions[i], 2, 200000);
      EXPECT_NEAR(found[i][2], expected, 0.025 * expected)
          << "sun " << sun << " elevation " << directions[i].elevation_deg;
    }
  }
}

TEST(Hillaire, GivesBackAllLightOverWhiteGroundInAirThatDoesNotAbsorb) {
  json document = with_air(earth(100, 60), evenly_scattering_air(1));
  document["planet"]["ground_albedo"] = 1;
  Radiances found = device().radiance(scene_of(document), {{-90, 0}}, true);
  ASSERT_TRUE(found.irradiance);
  for (double up : found.irradiance->diffuse_up) {
    // What leaves the ground goes through a larger sphere where it leaves the air.
    double incident = std::sin(glm::radians(60.0)) * std::pow(6360.0 / 6460, 2);
    EXPECT_NEAR(up, incident, 0.01 * incident);
  }
}

TEST(Hillaire, OfMoreOrdersIsBrighterAndComesToAllOfThem) {
  std::vector<Direction> directions{{90, 0}, {5, 120}, {-30, 40}};
  std::vector<std::vector<double>> previous(3, std::vector<double>(3, 0.0));
  for (int orders : {1, 2, 3, 6}) {
    auto found =
        radiance(scene_of(earth(0.5, 30), {{"scattering_orders", orders}}), directions);
    for (int i = 0; i < 9; ++i)
      EXPECT_GT(found[i / 3][i % 3], previous[i / 3][i % 3]) << orders;
    previous = found;
  }
  auto many = radiance(scene_of(earth(0.5, 30), {{"scattering_orders", 200}}), directions);
  auto all = radiance(scene_of(earth(0.5, 30)), directions);
  for (int i = 0; i < 9; ++i) {
    EXPECT_GE(many[i / 3][i % 3], previous[i / 3][i % 3]);
    EXPECT_NEAR(many[i / 3][i % 3], all[i / 3][i % 3], 1e-3 * all[i / 3][i % 3]);
  }
}

TEST(Hillaire, LightsTheGroundByTheSkyAfterSunset) {
  for (double sun : {0.0, -0.5, -2.0, -6.0}) {
    auto found = radiance(scene_of(earth(0.002, sun)), {{-80, 0}});
    for (double value : found[0]) EXPECT_GT(value, 0) << sun;
  }
}

TEST(Hillaire, IsTheSameToTheLeftAndToTheRightOfTheSun) {
  Scene scene = scene_of(earth(0.002, 4));
  for (double azimuth : {0.01, 1.0, 60.0, 179.0, 179.99}) {
    for (double elevation : {-20.0, 0.5, 20.0, 80.0}) {
      auto found = radiance(scene, {{elevation, azimuth}, {elevation, -azimuth}});
      for (int w = 0; w < 3; ++w) EXPECT_NEAR(found[0][w], found[1][w], 2e-5 * found[1][w]);
    }
  }
}

TEST(Hillaire, HasNoCreaseTowardsTheSunOrAwayFromIt) {
  // Even functions have no slope there: over a small angle radiance changes with its square. Of
  // a crease it would change in proportion.
  for (double sun : {30.0, 3.0, -4.0}) {
    Scene scene = scene_of(earth(0.002, sun), {{"sky_azimuths", 24}});
    for (double azimuth : {0.0, 180.0}) {
      for (double elevation : {4.0, 15.0, 70.0}) {
        double whole = azimuth == 0 && std::abs(elevation - sun) < 20 ? 1.0 : 4.0;
        auto found = radiance(scene, {{elevation, azimuth},
                                      {elevation, azimuth + whole / 2},
                                      {elevation, azimuth + whole}});
        for (int w = 0; w < 3; ++w) {
          double half_step = std::abs(found[1][w] - found[0][w]);
          double step = std::abs(found[2][w] - found[0][w]);
          EXPECT_LT(half_step, 0.36 * step + 1e-5 * found[0][w])
              << "sun " << sun << " azimuth " << azimuth << " elevation " << elevation;
        }
      }
    }
  }
}

/// The largest relative difference between pixels from the sky view and marched ones.
double from_march(const json& document, const std::vector<Direction>& directions) {
  auto table = radiance(scene_of(document), directions);
  auto march = radiance(scene_of(document, {{"march_pixels", 1}}), directions);
  double worst = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (int w = 0; w < 3; ++w) {
      worst = std::max(worst, std::abs(table[i][w] / march[i][w] - 1));
    }
  }
  return worst;
}

TEST(Hillaire, SkyViewMeetsTheMarchOnBothSidesOfTheHorizon) {
  for (double altitude_km : {0.0, 0.002, 0.01, 1.0, 10.0, 50.0}) {
    double dip = glm::degrees(std::acos(6360 / (6360 + altitude_km)));
    std::vector<Direction> directions;
    for (double offset : {-0.1, -0.01, -1e-3, 1e-3, 0.01, 0.1}) {
      for (double azimuth : {0.0, 70.0, 180.0}) directions.push_back({offset - dip, azimuth});
    }
    for (double sun : {30.0, 1.0}) {
      // High up, the limb of the whole air lies between a few rows.
      double bound = altitude_km < 5 ? 0.01 : altitude_km < 20 ? 0.02 : 0.05;
      EXPECT_LT(from_march(earth(altitude_km, sun), directions), bound)
          << "altitude " << altitude_km << " sun " << sun;
    }
  }
}

TEST(Hillaire, ChangesNothingWhereTheCameraLeavesTheAir) {
  std::vector<Direction> directions{{-90, 0},    {-40, 30},  {-20, 90},
                                    {-10.5, 10}, {-9.5, 60}, {-8, 120}};
  auto below = radiance(scene_of(earth(99.9999, 10)), directions);
  auto above = radiance(scene_of(earth(100.0001, 10)), directions);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (int w = 0; w < 3; ++w) {
      EXPECT_NEAR(below[i][w], above[i][w], 0.01 * above[i][w])
          << "elevation " << directions[i].elevation_deg;
    }
  }
}

TEST(Hillaire, DoesNotDependOnHowItsWorkIsCut) {
  std::vector<Direction> directions;
  for (int i = 0; i < 300; ++i) directions.push_back({-20 + 0.3 * i, 1.1 * i});
  json options = {{"sky_azimuths", 24},
                  {"sky_elevations", 16},
                  {"multiple_suns", 12},
                  {"multiple_altitudes", 8},
                  {"multiple_directions", 16}};
  json wide = earth(0.5, 4);
  wide["sun"]["disc_samples"] = 3;
  for (const json& document : {earth(0.5, 4), wide}) {
    Scene scene = scene_of(document, options);
    Engine slicing({.device = "", .longest_dispatch_ms = 1e-4});
    Radiances sliced = slicing.radiance(scene, directions, false);
    Radiances whole = device().radiance(scene, directions, false);
    EXPECT_EQ(sliced.radiance, whole.radiance);
    EXPECT_EQ(sliced.transmittance, whole.transmittance);
  }
}

TEST(Hillaire, IsTheSameWhateverTablesAreThereAlready) {
  std::vector<Direction> directions{{60, 10}, {5, 100}, {-20, 200}};
  auto first = radiance(scene_of(earth(0.002, 12)), directions);
  json turned = earth(0.002, 12);
  turned["sun"]["azimuth_deg"] = 77;
  radiance(scene_of(turned), directions);
  radiance(scene_of(earth(3, 20)), directions);
  Engine fresh;
  radiance(scene_of(turned), directions);
  EXPECT_EQ(radiance(scene_of(earth(0.002, 12)), directions), first);
  fresh.radiance(scene_of(turned), directions, false);
  EXPECT_EQ(fresh.radiance(scene_of(earth(0.002, 12)), directions, false).radiance, first);
}

TEST(Hillaire, UnderASunFarAwayOrOfManyPointsIsThatUnderOneBeam) {
  std::vector<Direction> directions{{90, 0}, {12, 70}, {-30, 40}};
  auto one = radiance(scene_of(earth(0.002, 25)), directions);
  json near = earth(0.002, 25), wide = near;
  near["sun"]["distance_km"] = 1.5e8;
  wide["sun"]["angular_diameter_deg"] = 0.02;
  wide["sun"]["disc_samples"] = 7;
  for (const json& document : {near, wide}) {
    auto found = radiance(scene_of(document), directions);
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(found[i / 3][i % 3], one[i / 3][i % 3], 5e-3 * one[i / 3][i % 3]);
    }
  }
}

}  // namespace
}  // namespace cyanometer::oracle
