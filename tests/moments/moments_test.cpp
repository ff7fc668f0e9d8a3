// The moment method on the device against solutions of other kinds.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <tuple>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/scene/document.h"
#include "tests/device.h"
#include "tests/moments/reference.h"
#include "tests/oracle/scenes.h"

namespace cyanometer {
namespace {

using oracle::reference_scene;
using oracle::towards;
using Samples = std::vector<std::vector<double>>;

MethodChoice chosen(const std::string& name,
                    const std::map<std::string, double>& options = {}) {
  MethodChoice choice;
  choice.name = name;
  for (const MethodDescription& method : methods()) {
    if (method.name != name) continue;
    for (const MethodOption& option : method.options) {
      choice.options[option.name] = option.default_value;
    }
  }
  for (auto [option, value] : options) choice.options[option] = value;
  return choice;
}

/// All orders; clear air with aerosol of optical depth 0.005.
Scene clear_scene(double altitude_km, double sun_elevation_deg) {
  Scene scene = reference_scene(altitude_km, sun_elevation_deg, 0.3);
  scene.method = chosen("moments");
  return scene;
}

Scene hazy_scene(double altitude_km, double sun_elevation_deg) {
  Scene scene = clear_scene(altitude_km, sun_elevation_deg);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2},
      Particles{ParticleCoefficients{0.158, 0.0083}, HenyeyGreenstein{0.76}}};
  return scene;
}

std::vector<Direction> spread_directions() {
  std::vector<Direction> directions;
  for (double elevation : {80.0, 45.0, 20.0, 8.0, 2.0, -5.0, -20.0, -70.0}) {
    for (double azimuth : {3.0, 50.0, 110.0, 175.0}) directions.push_back({elevation, azimuth});
  }
  return directions;
}

Problem problem_of(const Scene& scene) {
  return make_problem(scene, scene.spectrum.wavelengths_nm);
}

/// |d| of the contract's measure, ascending, over directions and wavelengths.
std::vector<double> differences(const Samples& found, const Samples& expected) {
  std::vector<double> all = relative_differences(found, expected);
  for (double& d : all) d = std::abs(d);
  std::sort(all.begin(), all.end());
  return all;
}
double share(const std::vector<double>& sorted, double quantile) {
  return sorted[static_cast<std::size_t>(quantile * static_cast<double>(sorted.size()))];
}
void print(const char* what, const std::vector<double>& d) {
  std::printf("%s: median %.2e, 95 %% %.2e, largest %.2e\n", what, share(d, 0.5),
              share(d, 0.95), d.back());
}

Samples by_reference(MomentReference& reference, const Scene& scene,
                     const std::vector<Direction>& directions) {
  Problem problem = problem_of(scene);
  oracle::Adaptive first(pack<double>(problem), 1e-5);
  Samples all;
  for (const Direction& d : directions) {
    glm::dvec3 view = towards(d.elevation_deg, d.azimuth_deg);
    oracle::Ray one = first.trace(view);
    glm::dvec4 more = reference.further_radiance(problem, view);
    all.emplace_back();
    for (int w = 0; w < 3; ++w)
      all.back().push_back(one.inscatter[w] + one.ground[w] + more[w]);
  }
  return all;
}

TEST(Moments, AreWithinAFewPermilleOfManyMomentsInDoubleByDayAndTwoPercentDownToTheEndOfDusk) {
  MomentReference reference(problem_of(clear_scene(0, 30)), {});
  std::vector<double> day, dusk;
  for (double sun : {60.0, 20.0, 3.0, -2.0, -6.0}) {
    for (double altitude : {0.0, 10.0}) {
      Scene scene = clear_scene(altitude, sun);
      auto d = differences(device().radiance(scene, spread_directions(), false).radiance,
                           by_reference(reference, scene, spread_directions()));
      if (sun > 0) day.insert(day.end(), d.begin(), d.end());
      dusk.insert(dusk.end(), d.begin(), d.end());
    }
  }
  std::sort(day.begin(), day.end());
  std::sort(dusk.begin(), dusk.end());
  print("day", day);
  print("to the end of dusk", dusk);
  EXPECT_LT(share(day, 0.5), 2e-3);
  EXPECT_LT(share(day, 0.95), 1e-2);
  EXPECT_LT(share(dusk, 0.95), 2e-2);
}

/// The 30 published cases of conservative Rayleigh air between planes, here on a vast planet.
TEST(Moments, OnAFlatPlanetAreTheDiscreteOrdinates) {
  Samples found, expected, flux, expected_flux;
  nlohmann::json published = oracle::published("discrete_ordinates.json");
  for (const auto& row : published["cases"]) {
    for (bool top : {false, true}) {
      Scene scene;
      scene.method = chosen("moments");
      scene.planet.radius_km = 1e6;
      scene.planet.ground_albedo = row["ground_albedo"].get<double>();
      scene.atmosphere.thickness_km = 10;
      scene.atmosphere.constituents.clear();
      scene.atmosphere.constituents["air"] = {
          UniformProfile{}, Molecules{ScatteringCoefficient{row["tau"].get<double>() / 10}}};
      scene.spectrum = {{550}, Colour::channels};
      scene.sun.irradiance = Spectrum{1.0};
      scene.sun.elevation_deg = 90 - row["sun_zenith_deg"].get<double>();
      scene.camera.altitude_km = top ? 10 : 0;
      std::vector<Direction> directions;
      for (const auto& d : row["rows"]) {
        double zenith = d[0];
        directions.push_back({top ? zenith - 90 : 90 - zenith, d[1].get<double>()});
        expected.push_back({d[top ? 3 : 2].get<double>()});
      }
      Radiances all = device().radiance(scene, directions, true);
      found.insert(found.end(), all.radiance.begin(), all.radiance.end());
      flux.push_back(top ? all.irradiance->diffuse_up : all.irradiance->diffuse_down);
      expected_flux.push_back({row[top ? "diffuse_up_top" : "diffuse_down_ground"]});
    }
  }
  auto d = differences(found, expected);
  print("discrete ordinates", d);
  auto of_fluxes = differences(flux, expected_flux);
  print("their fluxes", of_fluxes);
  EXPECT_LT(of_fluxes.back(), 1.2e-2);
  EXPECT_LT(share(d, 0.5), 2e-3);
  EXPECT_LT(share(d, 0.95), 1.2e-2);
}

/// Straight up, order two is an integral over the vertical of order one from all directions,
/// which the adaptive quadrature gives.
std::vector<double> second_order_in_the_zenith(const Scene& scene) {
  Problem problem = problem_of(scene);
  Physics<double> p = pack<double>(problem);
  GaussRule along = gauss_legendre(6), zenith = gauss_legendre(8);
  constexpr int azimuths = 8;
  constexpr double pi = std::numbers::pi;
  std::vector<double> sum(3, 0.0);
  double column[Physics<double>::MEDIA_SIZE], density[Physics<double>::MEDIA_SIZE];
  glm::dvec4 phase[Physics<double>::MEDIA_GROUPS_SIZE];
  auto cuts = p.cuts_of(0, 1, problem.thickness_km);
  for (int k = 0; k < 6; ++k) {
    auto node = p.ray_node(cuts, along.nodes[k], along.weights[k]);
    p.columns_along(0, 1, node.t_km, column);
    p.densities(node.t_km, density);
    glm::dvec4 seen = p.transmittance_of(column, 0) * node.width_km;
    problem.camera.altitude_km = node.t_km;
    oracle::Adaptive first(pack<double>(problem), 1e-3);
    for (int j = 0; j < 16; ++j) {
      auto ring = p.zenith_node(node.t_km, j >= 8, zenith.nodes[j % 8], zenith.weights[j % 8]);
      for (int a = 0; a < azimuths; ++a) {
        double azimuth = pi * (a + 0.5) / azimuths, sine = std::sqrt(1 - ring.mu * ring.mu);
        glm::dvec3 from(sine * std::sin(azimuth), sine * std::cos(azimuth), ring.mu);
        oracle::Ray light = first.trace(from);
        p.scattering_towards(p.scattering_angle(from, glm::dvec3(0, 0, 1)), phase);
        for (int w = 0; w < 3; ++w) {
          double source = 0;
          for (int c = 0; c < p.MEDIA; ++c) {
            source += density[c] * phase[c * Physics<double>::GROUPS_SIZE][w];
          }
          sum[w] += source * seen[w] * (light.inscatter[w] + light.ground[w]) * ring.weight *
                    2 * pi / azimuths;
        }
      }
    }
  }
  return sum;
}

TEST(Moments, OfOrderTwoInTheZenithAreTheIntegralOfOrderOne) {
  for (double sun : {40.0, 5.0}) {
    Scene scene = clear_scene(0, sun);
    scene.atmosphere.constituents.erase("aerosol");  // a peak would need a finer rule
    scene.method.scattering_orders = 2;
    std::vector<double> two = device().radiance(scene, {{90, 0}}, false).radiance[0];
    scene.method.scattering_orders = 1;
    std::vector<double> one = device().radiance(scene, {{90, 0}}, false).radiance[0];
    std::vector<double> expected = second_order_in_the_zenith(scene);
    for (int w = 0; w < 3; ++w) {
      EXPECT_NEAR(two[w] - one[w], expected[w], 0.006 * expected[w]) << "sun " << sun;
    }
  }
}

TEST(Moments, OfOrderOneAreTheMarch) {
  Scene scene = clear_scene(0, 8), march = scene;
  march.method = chosen("raymarch");
  scene.method.scattering_orders = march.method.scattering_orders = 1;
  EXPECT_EQ(device().radiance(scene, spread_directions(), false).radiance,
            device().radiance(march, spread_directions(), false).radiance);
}

TEST(Moments, GrowByEveryOrderTowardsAllOfThem) {
  Scene scene = hazy_scene(0, 25);
  std::vector<double> before(3, 0.0), last_step(3, 1e9);
  for (int orders = 1; orders <= 6; ++orders) {
    scene.method.scattering_orders = orders;
    std::vector<double> now = device().radiance(scene, {{30, 120}}, false).radiance[0];
    for (int w = 0; w < 3; ++w) {
      EXPECT_GT(now[w], before[w]);
      EXPECT_LT(now[w] - before[w], last_step[w]);
      last_step[w] = now[w] - before[w];
    }
    before = now;
  }
  scene.method.scattering_orders.reset();
  std::vector<double> all = device().radiance(scene, {{30, 120}}, false).radiance[0];
  for (int w = 0; w < 3; ++w) EXPECT_NEAR(all[w], before[w], 0.04 * all[w]);
}

/// The largest difference from many orders of what few orders tell.
double left_by(int orders, Scene scene) {
  auto with = [&](int count) {
    scene.method = chosen("moments", {{"degree", 4}, {"orders", count}});
    return device().radiance(scene, spread_directions(), false).radiance;
  };
  return differences(with(orders), with(64)).back();
}

TEST(Moments, FollowAllOrdersFromAFewByTheModesThatFade) {
  Scene thick = clear_scene(0, 30);
  thick.planet.ground_albedo = 0.9;
  thick.atmosphere.constituents["air"] = {ExponentialProfile{8},
                                          Molecules{ScatteringCoefficient{3.0 / 8}}};
  EXPECT_LT(left_by(16, thick), 5e-3);
  EXPECT_LT(left_by(4, clear_scene(0, 30)), 1e-3);
  EXPECT_LT(left_by(4, clear_scene(0, -6)), 2e-3);
  EXPECT_LT(left_by(6, hazy_scene(0, 10)), 2e-3);
}

TEST(Moments, MakeNoLightInThickAirWithFewNodes) {
  // With 6 nodes to a ray each order was a tenth brighter than the one before.
  Scene scene = clear_scene(0, 34);
  scene.planet.ground_albedo = 0.85;
  scene.atmosphere.constituents.clear();
  scene.atmosphere.constituents["air"] = {ExponentialProfile{8},
                                          Molecules{ScatteringCoefficient{6.0 / 8}}};
  scene.method = chosen("moments", {{"degree", 2},
                                    {"altitudes", 6},
                                    {"suns", 12},
                                    {"directions", 6},
                                    {"azimuths", 4},
                                    {"steps", 6}});
  scene.method.scattering_orders = 60;
  double before = 0;
  for (int orders : {10, 30, 50, 60}) {
    scene.method.scattering_orders = orders;
    double now = device().radiance(scene, {{60, 120}}, false).radiance[0][0];
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_LT(before, 1 / std::numbers::pi);
}

TEST(Moments, ComeCloserToTheSolutionWithTheirDegreeInHaze) {
  Scene scene = hazy_scene(0, 20);
  Scene walk = scene;
  walk.method = chosen("path", {{"samples_per_pixel", 1 << 16}});
  Samples expected = device().radiance(walk, spread_directions(), false).radiance;
  std::vector<double> error;
  for (int degree : {2, 4, 8, 12}) {
    scene.method = chosen("moments", {{"degree", degree},
                                      {"suns", 14},
                                      {"directions", 12},
                                      {"azimuths", 14},
                                      {"steps", 16},
                                      {"orders", 6}});
    auto found = device().radiance(scene, spread_directions(), false).radiance;
    auto d = differences(found, expected);
    print("haze", d);
    error.push_back(measure_error(found, expected).error);
  }
  EXPECT_LT(error[1], error[0]);
  EXPECT_LT(error[2], 0.5 * error[1]);
  EXPECT_LT(error[3], 0.75 * error[2]);  // walks leave 0.2 %
}

TEST(Moments, AreWithinTwoPercentOfRandomWalksInHazeWithAPeak) {
  struct Case {
    double g, sun_elevation_deg;
    int walks;
  };
  constexpr double noise = 0.005;  // 95 % of the walks' own errors are less
  for (auto [g, sun, walks] :
       {Case{0.76, 20, 1 << 14}, {0.8, 20, 1 << 14}, {0.8, 5, 1 << 16}}) {
    Scene scene = hazy_scene(0, sun);
    std::get<Particles>(scene.atmosphere.constituents["aerosol"].matter).phase =
        HenyeyGreenstein{g};
    Scene walk = scene;
    walk.method = chosen("path", {{"samples_per_pixel", walks}});
    auto d = differences(device().radiance(scene, spread_directions(), false).radiance,
                         device().radiance(walk, spread_directions(), false).radiance);
    print("haze against walks", d);
    EXPECT_LT(share(d, 0.95), 0.02 + noise) << g << " " << sun;
  }
}

Scene thick_haze(double g, double sun_elevation_deg) {
  Scene scene = clear_scene(0, sun_elevation_deg);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2}, Particles{ParticleOpticalDepth{1.0, 1.0}, HenyeyGreenstein{g}}};
  return scene;
}

TEST(Moments, AreWithinATenthOfRandomWalksUnderNarrowPeaks) {
  for (auto [g, most_median, most] : {std::tuple{0.9, 0.02, 0.07}, {0.97, 0.04, 0.15}}) {
    Scene scene = thick_haze(g, 33), walk = scene;
    walk.method = chosen("path", {{"samples_per_pixel", 1 << 14}});
    auto d = differences(device().radiance(scene, spread_directions(), false).radiance,
                         device().radiance(walk, spread_directions(), false).radiance);
    print("narrow peak against walks", d);
    EXPECT_LT(share(d, 0.5), most_median) << g;
    EXPECT_LT(share(d, 0.95), most) << g;
  }
}

/// Of the logarithm of a sky's radiance, its largest bend over steps of 3 deg along parallels,
/// further than 20 deg from the sun's azimuth.
double largest_bend(const Scene& scene) {
  constexpr int azimuths = 54;
  std::vector<Direction> directions;
  for (double elevation = 10; elevation < 90; elevation += 10) {
    for (int i = 0; i < azimuths; ++i) directions.push_back({elevation, 20 + 3.0 * i});
  }
  Samples sky = device().radiance(scene, directions, false).radiance;
  double worst = 0;
  for (std::size_t i = 1; i + 1 < sky.size(); ++i) {
    if (directions[i + 1].elevation_deg != directions[i - 1].elevation_deg) continue;
    for (std::size_t w = 0; w < sky[i].size(); ++w) {
      double bend = sky[i - 1][w] * sky[i + 1][w] / (sky[i][w] * sky[i][w]);
      worst = std::max(worst, std::abs(std::log(bend)));
    }
  }
  return worst;
}

/// A series of eight degrees is negative beside a peak two degrees wide.
TEST(Moments, LeaveNoPatchesBesideNarrowPeaks) {
  for (double g : {0.93, 0.97, 0.99}) {
    for (double sun : {33.0, 12.0}) {
      EXPECT_LT(largest_bend(thick_haze(g, sun)), 0.05) << g << " " << sun;
    }
  }
}

/// There high moments are as good as nothing, and must not be divided by that.
TEST(Moments, OfHighDegreesKeepTheirPlaceUnderAHighSun) {
  for (double sun : {60.0, 85.0}) {
    Scene scene = hazy_scene(0, sun);
    Samples usual = device().radiance(scene, spread_directions(), false).radiance;
    scene.method = chosen("moments", {{"degree", 12}});
    auto d = differences(device().radiance(scene, spread_directions(), false).radiance, usual);
    print("degree 12", d);
    EXPECT_LT(d.back(), 0.02) << sun;
  }
}

TEST(Moments, OfDustAreNowhereTensOfPercentOff) {
  Scene scene =
      read_scene({{"preset", "earth_dust"},
                  {"method", {{"name", "moments"}}},
                  {"spectrum", {{"wavelengths_nm", {680, 550, 440}}, {"colour", "channels"}}}});
  Scene walk = scene;
  walk.method = chosen("path", {{"samples_per_pixel", 4096}});
  auto d = differences(device().radiance(scene, spread_directions(), false).radiance,
                       device().radiance(walk, spread_directions(), false).radiance);
  print("dust against walks", d);
  EXPECT_LT(d.back(), 0.15);
}

/// Values that are apart by more than three standard errors and a hundredth.
int apart_from_walks(const Scene& scene, const std::vector<Direction>& directions) {
  Scene walk = scene;
  walk.method = chosen("path", {{"samples_per_pixel", 4096}});
  Samples found = device().radiance(scene, directions, false).radiance;
  Radiances expected = device().radiance(walk, directions, false);
  int apart = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (int w = 0; w < 3; ++w) {
      double bound = 3 * (*expected.standard_error)[i][w] + 0.01 * expected.radiance[i][w];
      apart += std::abs(found[i][w] - expected.radiance[i][w]) > bound;
    }
  }
  return apart;
}

TEST(Moments, AgreeWithRandomWalksFromGroundToSpace) {
  for (double altitude : {0.0, 12.0, 400.0}) {
    std::vector<Direction> directions = spread_directions();
    if (altitude > 100) directions = {{-19, 20}, {-19.5, 160}, {-22, 60}, {-40, 10}, {-85, 0}};
    int apart = apart_from_walks(clear_scene(altitude, 35), directions);
    EXPECT_LE(apart, 1 + static_cast<int>(directions.size()) / 16) << altitude;
  }
}

TEST(Moments, AgreeWithRandomWalksUnderANearSun) {
  Scene scene = clear_scene(0, 15);
  scene.sun.distance_km = 20000;
  EXPECT_LE(apart_from_walks(scene, spread_directions()), 3);
}

TEST(Moments, AgreeWithRandomWalksOnASmallPlanet) {
  Scene scene = clear_scene(0, 25);
  scene.planet.radius_km = 400;
  scene.atmosphere.thickness_km = 60;
  EXPECT_LE(apart_from_walks(scene, spread_directions()), 3);
}

TEST(Moments, DoNotDependOnHowTheirWorkIsCutOrWhatIsKept) {
  Scene scene = hazy_scene(0.5, 4), other = hazy_scene(0.5, 30);
  scene.sun.disc_samples = other.sun.disc_samples = 3;
  Engine slicing({.device = "", .longest_dispatch_ms = 1e-2});
  Radiances sliced = slicing.radiance(scene, spread_directions(), false);
  device().radiance(other, spread_directions(), false);
  Radiances whole = device().radiance(scene, spread_directions(), false);
  Radiances again = device().radiance(scene, spread_directions(), false);
  EXPECT_EQ(sliced.radiance, whole.radiance);
  EXPECT_EQ(again.radiance, whole.radiance);
  EXPECT_EQ(sliced.transmittance, whole.transmittance);
}

TEST(Moments, ThatNobodyWaitsForLeaveNothingBehind) {
  Scene scene = hazy_scene(0, 33);
  Engine engine;
  Watch late;
  late.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  EXPECT_THROW(engine.radiance(scene, spread_directions(), false, late), Cancelled);
  EXPECT_EQ(engine.radiance(scene, spread_directions(), false).radiance,
            device().radiance(scene, spread_directions(), false).radiance);
}

TEST(Moments, AreFiniteAndNotNegativeInThickDarkAndStrangeScenes) {
  for (const char* preset : {"mars_sunset", "titan", "airless_moon", "earth_twilight"}) {
    Scene scene = read_scene(
        {{"preset", preset},
         {"method", {{"name", "moments"}}},
         {"spectrum", {{"wavelengths_nm", {680, 550, 440}}, {"colour", "channels"}}}});
    std::vector<Direction> directions = spread_directions();
    directions.push_back({90, 0});
    directions.push_back({-90, 0});
    for (const auto& ray : device().radiance(scene, directions, false).radiance) {
      for (double value : ray) EXPECT_TRUE(std::isfinite(value) && value >= 0) << preset;
    }
  }
}

TEST(Moments, AreNoneWhereThereIsNoAir) {
  Scene scene =
      read_scene({{"preset", "airless_moon"},
                  {"spectrum", {{"wavelengths_nm", {680, 550, 440}}, {"colour", "channels"}}},
                  {"camera", {{"altitude_km", 0.002}, {"pitch_deg", 0}}}});
  scene.method = chosen("moments");
  auto all = device().radiance(scene, spread_directions(), false).radiance;
  scene.method = chosen("raymarch");
  scene.method.scattering_orders = 1;
  EXPECT_EQ(all, device().radiance(scene, spread_directions(), false).radiance);
}

// Profiles of tables are searched in loops, and drivers end all loops of an invocation, without
// a word, after so many rounds: many azimuths must be cut into several dispatches in time.
TEST(Moments, AreNotCutShortByTheirLoops) {
  Scene scene =
      read_scene({{"preset", "titan"},
                  {"spectrum", {{"wavelengths_nm", {680, 550, 440}}, {"colour", "channels"}}},
                  {"camera", {{"altitude_km", 0.5}, {"projection", "perspective"}}}});
  auto at = [&](int azimuths) {
    Plan plan;
    plan.method = "moments";
    plan.options = chosen("moments", {{"altitudes", 6},
                                      {"suns", 10},
                                      {"steps", 12},
                                      {"directions", 6},
                                      {"azimuths", azimuths}})
                       .options;
    plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
    return device().radiance(scene, spread_directions(), false, plan).radiance;
  };
  EXPECT_LT(measure_error(at(16), at(8)).error, 0.02);
}

TEST(Moments, NothingIsSeenThroughAirThatHidesEverything) {
  Scene scene = clear_scene(0, 40);
  scene.atmosphere.constituents["ozone"] = {
      TentProfile{40, 10}, Particles{ParticleCoefficients{1e4, 3e3}, HenyeyGreenstein{0.5}}};
  for (double degree : {2, 4}) {
    scene.method.options["degree"] = degree;
    for (const auto& ray :
         device().radiance(scene, {{90, 0}, {30, 0}, {2, 90}}, false).radiance)
      for (double value : ray) EXPECT_EQ(value, 0) << degree;
  }
}

TEST(Moments, TablesOfNoLightAreNotThoseOfAll) {
  Scene scene = clear_scene(0.1, 33.3);
  Scene none = scene;
  none.method.scattering_orders = 0;
  const auto seen = [&](const Scene& asked) {
    return device().radiance(asked, spread_directions(), false).radiance;
  };
  device().forget_tables();
  const Samples expected = seen(scene);
  device().forget_tables();
  for (const auto& ray : seen(none))
    for (double value : ray) EXPECT_EQ(value, 0);
  EXPECT_EQ(seen(scene), expected);
}

}  // namespace
}  // namespace cyanometer
