// Scenes in which the stability suite found a method to break: each stays mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/accuracy/random_scene.h"
#include "engine/scene/document.h"
#include "engine/stability/random_trials.h"
#include "engine/stability/row.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// That random scenes had when they were found.
const json found_image{{"width", 640}, {"height", 360}};

Trial trial(const char* method) {
  static const Watch watch;
  return Trial(device(), method, {}, 1 << 15, watch);
}

const StabilityRow& row(int number) {
  return stability_rows().at(static_cast<std::size_t>(number - 1));
}

/// A radiance that is not finite throws.
double measured(const char* method, int number, double trigger) {
  Trial asked = trial(method);
  return std::ranges::max(row(number).measure(asked, trigger), {}, &Measured::value).value;
}

TEST(FoundScenes, TheHorizonSeenFromTheGroundItselfIsFinite) {
  for (const char* method : {"raymarch", "hillaire", "bruneton", "moments"}) {
    json scene = changed(plain_scene(), {{"camera", {{"altitude_km", 0}}}});
    Trial asked = trial(method);
    EXPECT_NO_THROW(asked.look(scene, fan({0.002, 0, -0.002, -0.1}, {30}))) << method;
  }
}

TEST(FoundScenes, AirThatNothingPassesIsFinite) {
  json scene = changed(plain_scene(), {{"spectrum", {{"wavelengths_nm", {10, 100, 200}}}}});
  Trial asked = trial("hillaire");
  EXPECT_NO_THROW(asked.look(scene, fan({90, 30, 0.5, -40}, {0, 180})));
}

TEST(FoundScenes, NoMoreComesOutOfPlaneThickAirThanWentIn) {
  json scene = changed(row(12).scene(1), {{"camera", {{"altitude_km", 100}}}});
  Trial asked = trial("hillaire");
  Radiances seen = asked.look(scene, {{-90, 0}}, true);
  double sunlight = std::sin(std::numbers::pi / 3);
  for (double up : seen.irradiance->diffuse_up) EXPECT_NEAR(up / sunlight, 1, 0.05);
}

TEST(FoundScenes, TablesOverWhiteGroundKeepTheLight) {
  EXPECT_LT(measured("bruneton", 12, 1), 0.01);
  EXPECT_LT(measured("moments", 12, 1), 0.01);
}

json dense_haze(double altitude_km) {
  return changed(plain_scene(),
                 {{"camera", {{"altitude_km", altitude_km}}},
                  {"method", {{"scattering_orders", 1}}},
                  {"atmosphere",
                   {{"constituents",
                     {{"aerosol",
                       {{"type", "particles"},
                        {"optical_depth", 10},
                        {"single_scattering_albedo", 0.95},
                        {"phase", {{"type", "henyey_greenstein"}, {"g", 0.7}}}}}}}}}});
}

TEST(FoundScenes, RaymarchSeesWhatIsNearInDenseHazeAndWhatIsFarAboveIt) {
  const std::pair<double, Direction> views[] = {
      {1, {-2, 40}}, {0.002, {45, 40}}, {0.002, {80, 40}}};
  for (const auto& [altitude_km, view] : views) {
    json scene = dense_haze(altitude_km);
    Trial asked = trial("raymarch");
    Radiances seen = asked.look(scene, {view});
    auto exact = asked.first_order(scene, {view});
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(seen.radiance[0][c] / exact[0][c], 1, 1e-3) << altitude_km << " km";
  }
}

TEST(FoundScenes, MomentsHaveNoSeamInTheGroundNextToTheHorizon) {
  EXPECT_LT(measured("moments", 1, 0.002), row(1).bound);
}

TEST(FoundScenes, AutoSaysHowMuchLightIsLostInThickAir) {
  Trial asked = trial("auto");
  for (const Measured& lost : row(12).measure(asked, 3))
    EXPECT_LE(lost.value, row(12).allowed(lost.stated));
}

TEST(FoundScenes, RoundingDoesNotDecideWhatTheEdgeOfTheAirShows) {
  // From 1200 km, a sun that moves by 0.002 deg made the limb jump by 4 %.
  json scene = random_scene(0);
  scene["image"] = found_image;
  const std::vector<Direction> rays = sample_directions(read_scene(scene), 16);
  Trial asked = trial("moments");
  std::vector<std::vector<double>> before;
  for (double azimuth : {-20.050, -20.052, -20.054, -20.056, -20.058}) {
    json turned = changed(scene, {{"sun", {{"azimuth_deg", azimuth}}}});
    auto now = asked.look(turned, rays).radiance;
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (std::size_t c = 0; c < now[i].size(); ++c)
        EXPECT_NEAR(now[i][c] / before[i][c], 1, 2e-3) << azimuth << ", ray " << i;
    }
    before = std::move(now);
  }
}

TEST(FoundScenes, LightThatAShortSeriesMakesNegativeDoesNotJump) {
  // Deep twilight in haze: air that scatters more by a few millionths changed it by 1 % and
  // back.
  json scene = random_scene(1320);
  scene["image"] = found_image;
  scene["method"] = {{"name", "moments"}, {"degree", 2},     {"altitudes", 6},
                     {"suns", 12},        {"directions", 6}, {"azimuths", 4},
                     {"steps", 14},       {"sky_steps", 6},  {"sky_elevations", 12}};
  const std::vector<Direction> rays = sample_directions(read_scene(scene), 16);
  Trial asked = trial("moments");
  double& scattering =
      scene["/atmosphere/constituents/air/scattering_per_km/power_law/value"_json_pointer]
          .get_ref<json::number_float_t&>();
  std::vector<std::vector<double>> before;
  for (int i = 0; i < 12; ++i, scattering *= 1 + 5e-6) {
    auto now = asked.look(scene, rays).radiance;
    for (std::size_t ray = 0; ray < before.size(); ++ray) {
      for (std::size_t c = 0; c < now[ray].size(); ++c)
        EXPECT_NEAR(now[ray][c] / before[ray][c], 1, 1e-4) << i << ", ray " << ray;
    }
    before = std::move(now);
  }
}

TEST(FoundScenes, CloudsAreSeenToWhereTheirLightComesFrom) {
  json scene = changed(plain_scene(), {{"camera", {{"altitude_km", 20}}}});
  for (double depth : {10.0, 100.0, 1000.0}) {
    scene["atmosphere"]["constituents"]["cloud"] = {
        {"type", "particles"},
        {"optical_depth", depth},
        {"profile", {{"type", "tent"}, {"centre_km", 3}, {"half_width_km", 1}}},
        {"phase", {{"type", "henyey_greenstein"}, {"g", 0.8}}}};
    Trial asked = trial("raymarch");
    EXPECT_LT(asked.error(scene, fan({-90, -30, -8}, {0, 90, 180}))->value, 3e-3) << depth;
  }
}

TEST(FoundScenes, DustThatThinsSlowerThanThePlanetIsWideIsAsDenseAsUniformDust) {
  // Its columns were none: light came through, and was made, a thousandfold at each order.
  auto dust = [](const json& profile) {
    return changed(empty_scene(), {{"camera", {{"altitude_km", 9000}}},
                                   {"atmosphere",
                                    {{"constituents",
                                      {{"dust",
                                        {{"type", "particles"},
                                         {"optical_depth", 2},
                                         {"phase", {{"type", "henyey_greenstein"}, {"g", 0.5}}},
                                         {"profile", profile}}}}}}}});
  };
  json tent = dust({{"type", "tent"}, {"centre_km", 50}, {"half_width_km", 1e5}});
  json uniform = dust({{"type", "uniform"}});
  const std::vector<Direction> rays = fan({-90, -75, -67}, {0, 90});
  for (const char* method : {"raymarch", "hillaire", "moments"}) {
    Trial asked = trial(method);
    auto seen = asked.look(tent, rays).radiance, expected = asked.look(uniform, rays).radiance;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[i][c] / expected[i][c], 1, 2e-3) << method << ", ray " << i;
    }
  }
}

TEST(FoundScenes, InterpolationMakesNoLightUnderAThickShellOfCloudAtNight) {
  // From node to node the light fell by fifteen decades, and a tenth of that was overshot,
  // order by order: 6e6 where there is none.
  static const Watch watch;
  const json trial = random_trial(device(), 1371, {.methods = {"moments"}}, watch);
  EXPECT_EQ(trial.at("failures"), json::array());
}

TEST(FoundScenes, AWavelengthThatTheAirHidesTakesNoNodesFromOthers) {
  // All were where the most opaque one could see: green was half too dark beside ultraviolet.
  const auto green_beside = [](double nm, double altitude_km) {
    const json scene =
        changed(plain_scene(), {{"camera", {{"altitude_km", altitude_km}}},
                                {"spectrum", {{"wavelengths_nm", {nm, 550, 680}}}},
                                {"method", {{"scattering_orders", 1}}}});
    Trial asked = trial("raymarch");
    std::vector<double> green;
    for (const auto& ray : asked.look(scene, fan({-60, -30, 1, 5, 30, 90}, {90})).radiance)
      green.push_back(ray[1]);
    return green;
  };
  for (double altitude_km : {0.002, 5.0, 400.0}) {
    const std::vector<double> alone = green_beside(440, altitude_km);
    for (double nm : {250.0, 200.0, 150.0, 100.0, 50.0, 10.0}) {
      const std::vector<double> found = green_beside(nm, altitude_km);
      for (std::size_t i = 0; i < alone.size(); ++i)
        EXPECT_NEAR(found[i], alone[i], 1e-3 * alone[i]) << nm << " nm, ray " << i;
    }
  }
}

TEST(FoundScenes, LightFromASkinOfOpaqueAirIsFound) {
  const json scene =
      changed(plain_scene(), {{"camera", {{"altitude_km", 400}}},
                              {"spectrum", {{"wavelengths_nm", {10, 60, 200}}}},
                              {"method", {{"scattering_orders", 1}, {"view_nodes", 16}}}});
  const auto rays = fan({-90, -50, -30}, {20, 150});
  Trial asked = trial("raymarch");
  const auto truth = asked.first_order(scene, rays), seen = asked.look(scene, rays).relative;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GT(truth[i][c], 0.001) << i;
      EXPECT_NEAR(seen[i][c], truth[i][c], 1e-3 * truth[i][c]) << i;
    }
  }
}

TEST(FoundScenes, AirThatLosesNothingGivesBackNoMoreThanItGets) {
  // The series of all orders over what is not lost, next to nothing: 270 times what the sun
  // sends in.
  const json scene{
      {"preset", "earth_polluted"},
      {"planet", {{"radius_km", 3.756256}}},
      {"camera", {{"altitude_km", 87.12893}}},
      {"atmosphere",
       {{"constituents",
         {{"ozone", nullptr},
          {"air",
           {{"refractive_index",
             {{"wavelengths_nm", {4.022483, 620.1606, 11029.125}},
              {"values", {1.08533583, 2.5143953, 1.9112915}}}},
            {"temperature_k", 940.3298},
            {"profile",
             {{"type", "tent"}, {"centre_km", 37.506454}, {"half_width_km", 15}}}}}}}}},
      {"sun", {{"distance_km", 19408.8}, {"irradiance", 1}}},
      {"spectrum", {{"wavelengths_nm", {10, 2048.3342, 5000}}}},
      {"method",
       {{"multiple_altitudes", 8},
        {"multiple_suns", 16},
        {"multiple_samples", 8},
        {"view_samples", 8}}}};
  Trial asked = trial("hillaire");
  const Radiances seen = asked.look(scene, {{-64.3258, 0.443207}});
  for (double radiance : seen.radiance.front()) EXPECT_LT(radiance, 1);
}

TEST(FoundScenes, AirOfWhichAHairsBreadthHidesTheRestGivesBackNoMoreThanItGets) {
  // Between nodes a kilometre apart, of a millionth of which nothing comes through, the column
  // fell below 0 and left one in the light: 2600 times what the sun sends in, by order two.
  const json scene = changed(
      empty_scene(),
      {{"planet", {{"radius_km", 10}}},
       {"camera", {{"altitude_km", 140}}},
       {"atmosphere",
        {{"constituents",
          {{"air",
            {{"type", "molecules"},
             {"scattering_per_km", 1e6},
             {"profile", {{"type", "uniform"}}}}},
           {"dark",
            {{"type", "absorber"},
             {"absorption_per_km", 18000},
             {"profile", {{"type", "exponential"}, {"scale_height_km", 8}}}}}}}}},
       {"method", {{"multiple_altitudes", 8}, {"multiple_samples", 8}, {"view_samples", 8}}}});
  Trial asked = trial("hillaire");
  for (const auto& ray : asked.look(scene, {{-83, 94}, {-60, 0}}).radiance) {
    for (double radiance : ray) EXPECT_LT(radiance, 0.25);
  }
}

/// Of what `moments` is asked, by all its settings that `auto` takes.
std::vector<std::map<std::string, double>> settings_of_moments() {
  for (const MethodDescription& method : methods()) {
    if (method.name == "moments") return method.ladder;
  }
  return {};
}

Radiances by_moments(json scene, const std::map<std::string, double>& options) {
  scene["method"]["name"] = "moments";
  for (const auto& [name, value] : options) scene["method"][name] = value;
  Trial asked = trial("moments");
  return asked.look(scene, sample_directions(read_scene(scene), 64));
}

TEST(FoundScenes, PeaksInDeepNightStayFinite) {
  // High moments divided by what little light there is overflowed, and spread from order to
  // order until all of the ground was NaN.
  for (std::uint64_t seed : {20049, 20100}) {
    for (std::size_t setting : {3, 4}) {
      EXPECT_NO_THROW(by_moments(random_scene(seed), settings_of_moments().at(setting)))
          << seed;
    }
  }
}

TEST(FoundScenes, LayersThatOnlyAbsorbDoNotBrightenTheRest) {
  // Few nodes on a ray miss a thin layer: what they missed was made up for by light, 1 % of
  // what is seen, a quarter of what was scattered twice and more.
  const json scene = random_scene(20091);
  std::map<std::string, double> options = settings_of_moments().at(2);
  options["steps"] = 24;
  const auto fine = by_moments(scene, options).radiance;
  for (int steps : {6, 7, 8}) {
    options["steps"] = steps;
    const auto few = by_moments(scene, options).radiance;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      for (std::size_t c = 0; c < fine[i].size(); ++c)
        EXPECT_NEAR(few[i][c], fine[i][c], 2e-3 * fine[i][c]) << steps << ", ray " << i;
    }
  }
}

}  // namespace
}  // namespace cyanometer
