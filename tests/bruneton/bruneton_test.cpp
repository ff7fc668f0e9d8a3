// Bruneton's tables against what does not know them: the adaptive integral, discrete ordinates,
// and laws.
#include "engine/methods/bruneton/bruneton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/image/panels.h"
#include "tests/bruneton/bruneton_testing.h"
#include "tests/bruneton/workshop.h"

namespace cyanometer {
namespace {

using Radiance = std::vector<std::vector<double>>;

Radiance radiance(const Scene& scene, const std::vector<Direction>& directions) {
  return device().radiance(scene, directions, false).radiance;
}

/// A quantile of the relative differences, over directions and wavelengths.
double difference(const Radiance& a, const Radiance& b, double quantile) {
  std::vector<double> d = relative_differences(a, b);
  for (double& x : d) x = std::abs(x);
  std::sort(d.begin(), d.end());
  return d[static_cast<std::size_t>(quantile * static_cast<double>(d.size() - 1))];
}

Radiance exact_first_order(const Scene& scene, const std::vector<Direction>& directions) {
  oracle::Adaptive integral(pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm)));
  Radiance exact;
  for (const Direction& d : directions) {
    oracle::Ray ray = integral.trace(oracle::towards(d.elevation_deg, d.azimuth_deg));
    exact.emplace_back();
    for (int w = 0; w < 3; ++w) exact.back().push_back(ray.inscatter[w] + ray.ground[w]);
  }
  return exact;
}

/// Of the first order alone, from its table with that many times the nodes of a small one.
double error_of_single_table(int times, double altitude_km, double sun_deg) {
  MethodOptions options = with_options({{"first_order", 1},
                                        {"altitudes", 6 * times},
                                        {"zeniths", 8 * times},
                                        {"suns", 12 * times},
                                        {"azimuths", 6 * times},
                                        {"samples", 24 * times}});
  Scene scene = hazy(altitude_km, sun_deg, 1, options);
  std::vector<Direction> directions = all_around(40);
  return difference(radiance(scene, directions), exact_first_order(scene, directions), 0.75);
}

TEST(Bruneton, ItsTableOfTheFirstOrderConvergesToTheIntegral) {
  for (double altitude_km : {0.0, 3.0}) {
    double coarse = error_of_single_table(1, altitude_km, 40),
           fine = error_of_single_table(3, altitude_km, 40);
    std::printf("at %g km: three of four directions within %.4f, then %.4f\n", altitude_km,
                coarse, fine);
    EXPECT_LT(fine, coarse / 3);
    EXPECT_LT(fine, 0.01);
  }
}

Scene rayleigh(double optical_depth, double albedo, double sun_zenith_deg) {
  Scene scene;
  scene.planet.radius_km = 1e6;
  scene.planet.ground_albedo = albedo;
  scene.atmosphere.constituents.clear();
  scene.atmosphere.constituents["air"] = {
      ExponentialProfile{8},
      Molecules{ScatteringCoefficient{optical_depth / (8 * (1 - std::exp(-100 / 8.0)))}}};
  scene.sun.elevation_deg = 90 - sun_zenith_deg;
  scene.sun.irradiance = Spectrum{1.0};
  scene.camera.altitude_km = 0;
  scene.spectrum = {{550}, Colour::channels};
  return scene;
}

TEST(Bruneton, AgreesWithDiscreteOrdinatesInPlaneParallelRayleighAir) {
  nlohmann::json reference = oracle::published("discrete_ordinates.json");
  std::vector<double> errors;
  for (std::size_t i : {5, 14, 23}) {
    const auto& c = reference["cases"][i];
    for (bool top : {false, true}) {
      Scene scene = rayleigh(c["tau"], c["ground_albedo"], c["sun_zenith_deg"]);
      use(scene, std::nullopt, small_tables({{"orders", 8}, {"samples", 24}}));
      scene.camera.altitude_km = top ? scene.atmosphere.thickness_km : 0;
      std::vector<Direction> directions;
      Radiance expected;
      for (const auto& row : c["rows"]) {
        double up = 90 - row[0].get<double>();
        directions.push_back({top ? -up : up, row[1]});
        expected.push_back({row[top ? 3 : 2]});
      }
      for (double e : relative_differences(radiance(scene, directions), expected)) {
        errors.push_back(std::abs(e));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  std::printf("median %.5f, largest %.5f\n", errors[errors.size() / 2], errors.back());
  EXPECT_LT(errors[errors.size() / 2], 2e-3);
  EXPECT_LT(errors.back(), 1e-2);
}

TEST(Bruneton, LosesNoLightOverWhiteGround) {
  for (double sun_zenith_deg : {20.0, 70.0}) {
    Scene scene = rayleigh(0.5, 1, sun_zenith_deg);
    use(scene, std::nullopt, small_tables({{"orders", 16}, {"samples", 24}}));
    scene.camera.altitude_km = scene.atmosphere.thickness_km;
    Radiances found = device().radiance(scene, {{-90, 0}}, true);
    double in = std::cos(glm::radians(sun_zenith_deg));
    EXPECT_NEAR(found.irradiance->diffuse_up[0], in, 5e-3 * in);
  }
}

/// Over that of the sun: what comes down less what goes up at the ground, and what comes in
/// less what goes out at the top, whichever is the more.
double net_flux(Scene scene, double sun_zenith_deg) {
  double in = std::cos(glm::radians(sun_zenith_deg)), worst = 0;
  for (double altitude_km : {0.0, scene.atmosphere.thickness_km}) {
    scene.camera.altitude_km = altitude_km;
    auto flux = device().radiance(scene, {{-90, 0}}, true).irradiance.value();
    double net = flux.direct[0] + flux.diffuse_down[0] - flux.diffuse_up[0];
    worst = std::max(worst, std::abs(net) / in);
  }
  return worst;
}

/// There dozens of orders are hardly less than one another.
TEST(Bruneton, LosesNoLightOverWhiteGroundInThickAir) {
  for (double depth : {2.0, 4.0, 6.0}) {
    Scene scene = rayleigh(depth, 1, 40);
    use(scene, std::nullopt, small_tables({{"altitudes", 16}, {"samples", 24}}));
    EXPECT_LT(net_flux(scene, 40), 0.05) << depth;
  }
}

/// Its grids have nodes every ten degrees and more; the peak is two degrees wide, and one.
TEST(Bruneton, MakesNoLightOfNarrowPeaks) {
  for (double g : {0.95, 0.99}) {
    Scene scene = rayleigh(1, 1, 57);
    Constituent haze{ExponentialProfile{1},
                     Particles{ParticleOpticalDepth{1.0, 1.0}, HenyeyGreenstein{g}}};
    scene.atmosphere.constituents = {{"haze", haze}};
    use(scene, std::nullopt, with_options({{"altitudes", 8}, {"suns", 16}}));
    EXPECT_LT(net_flux(scene, 57), 0.15) << g;
  }
}

TEST(Bruneton, EveryOrderAddsLessThanTheOneBeforeAndAllAreTheirSum) {
  std::vector<Direction> directions = all_around(16);
  auto with_orders = [&](std::optional<int> orders) {
    return radiance(hazy(0.5, 20, orders, small_tables({{"orders", 6}})), directions);
  };
  Radiance one = with_orders(1), two = with_orders(2), three = with_orders(3),
           many = with_orders(14), all = with_orders(std::nullopt);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t w = 0; w < 3; ++w) {
      double second = two[i][w] - one[i][w], third = three[i][w] - two[i][w];
      EXPECT_GT(third, 0);
      EXPECT_LT(third, second);
    }
  }
  EXPECT_LT(difference(all, many, 1), 1e-3);
  EXPECT_GT(difference(three, many, 0.5), 5e-3);
}

/// The first order with the haze's table of its own, and with one made from the molecules'.
std::pair<Radiance, Radiance> separate_and_reconstructed(Scene scene) {
  std::vector<Direction> directions;
  for (int i = 0; i < 24; ++i) directions.push_back({1 + 2.5 * i, 15.0 * i});
  auto with = [&](int first_order) {
    use(scene, 1, small_tables({{"first_order", first_order}}));
    return radiance(scene, directions);
  };
  return {with(1), with(2)};
}

TEST(Bruneton, ParticlesMadeFromTheMoleculesTableAreExactInTheFirstWavelengthOnly) {
  auto [separate, reconstructed] = separate_and_reconstructed(hazy(0, 6, 1, {}));
  double worst = 0;
  for (std::size_t i = 0; i < separate.size(); ++i) {
    EXPECT_NEAR(reconstructed[i][0], separate[i][0], 1e-4 * separate[i][0]);
    worst = std::max(worst, std::abs(reconstructed[i][2] / separate[i][2] - 1));
  }
  std::printf("blue is wrong by up to %.2f\n", worst);
  EXPECT_GT(worst, 0.05);
}

TEST(Bruneton, ParticlesMadeFromTheMoleculesTableAreExactWhereBothAreSpreadAlike) {
  Scene scene = hazy(0, 6, 1, {});
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{8}, Particles{ParticleCoefficients{0.002, 0.0}, CornetteShanks{0.8}}};
  auto [separate, reconstructed] = separate_and_reconstructed(scene);
  EXPECT_LT(difference(reconstructed, separate, 1), 1e-3);
}

TEST(Bruneton, DoesNotDependOnHowItsWorkIsCut) {
  Engine slicing({.device = "", .longest_dispatch_ms = 1e-4});
  for (int first_order : {0, 1}) {
    MethodOptions options = with_options({{"altitudes", 4},
                                          {"zeniths", 4},
                                          {"suns", 6},
                                          {"azimuths", 4},
                                          {"source_zeniths", 5},
                                          {"source_azimuths", 3},
                                          {"samples", 5},
                                          {"first_order", first_order}});
    Scene scene = hazy(0.5, 4, std::nullopt, options);
    Radiances sliced = slicing.radiance(scene, all_around(200), false);
    Radiances whole = device().radiance(scene, all_around(200), false);
    EXPECT_EQ(sliced.radiance, whole.radiance);
    EXPECT_EQ(sliced.transmittance, whole.transmittance);
  }
}

TEST(Bruneton, HasNoSeamWhereTheCameraLeavesTheAir) {
  std::vector<Direction> downwards;
  for (int i = 0; i < 24; ++i) downwards.push_back({-12 - 3.0 * i, 30.0 * i});
  auto at = [&](double altitude_km) {
    return radiance(hazy(altitude_km, 10, std::nullopt, small_tables()), downwards);
  };
  EXPECT_LT(difference(at(99.999), at(100.001), 1), 0.01);
}

/// Air that ends at its top, and the same with a trace of more that has no weight but leaves no
/// place empty.
TEST(Bruneton, LosesNoLightWhereAirEnds) {
  for (double altitude_km : {60.0, 9000.0}) {
    Scene scene = oracle::reference_scene(altitude_km, 25, 0.03);
    scene.atmosphere.constituents.clear();
    Molecules air{ScatteringCoefficient{PerWavelength{{0.0014, 0.0032, 0.0079}}}};
    scene.atmosphere.constituents["air"] = {QuadraticProfile{}, air};
    use(scene, std::nullopt, small_tables());
    Scene traced = scene;
    Molecules trace{ScatteringCoefficient{PerWavelength{{1e-9, 1e-9, 1e-9}}}};
    traced.atmosphere.constituents["trace"] = {UniformProfile{}, trace};
    std::vector<Direction> directions = sample_directions(scene, 128);
    EXPECT_LT(measure_error(radiance(scene, directions), radiance(traced, directions)).error,
              1e-3)
        << altitude_km;
  }
}

TEST(Bruneton, GathersForTheViewWhatTheTableHolds) {
  std::vector<Direction> directions = all_around(24);
  auto with_gather = [&](int gather) {
    MethodOptions options = with_options({{"gather", gather}});
    return radiance(hazy(1, 25, 3, options), directions);
  };
  EXPECT_LT(difference(with_gather(0), with_gather(1), 0.9), 0.02);
}

TEST(Bruneton, ItsTablesServeEverySunAndEveryCamera) {
  Workshop w;
  bruneton::Setup setup(small_tables());
  auto first = w.maker.source(w.tracer, w.upload(0, 30), setup);
  EXPECT_EQ(w.maker.source(w.tracer, w.upload(400, -5), setup), first);
  EXPECT_EQ(w.tables.count(), 1u);
  EXPECT_NE(w.maker.view(w.tracer, w.upload(0, 30), setup),
            w.maker.view(w.tracer, w.upload(1, 30), setup));
  EXPECT_EQ(w.maker.view(w.tracer, w.upload(400, 30), setup),
            w.maker.view(w.tracer, w.upload(36000, -5), setup));
}

std::vector<Panels> tables_with(const MethodOptions& changed, std::optional<int> orders) {
  return device().table_panels(hazy(0, 30, orders, small_tables(changed)));
}

std::vector<std::string> names(const std::vector<Panels>& all) {
  std::vector<std::string> found;
  for (const Panels& panels : all) found.push_back(panels.name);
  return found;
}

TEST(Bruneton, ShowsTheTablesThatAFrameIsMadeFrom) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(tables_with({}, std::nullopt)), (Names{"source", "irradiance", "view"}));
  EXPECT_EQ(names(tables_with({{"first_order", 1}}, 1)),
            (Names{"first_order_aerosol", "first_order_air", "first_order_ozone"}));
  EXPECT_TRUE(tables_with({}, 1).empty());
}

TEST(Bruneton, ItsTablesAreReadWithTheirAxes) {
  for (int gather : {0, 1}) {
    for (const Panels& panels : tables_with({{"gather", gather}}, std::nullopt)) {
      std::size_t nodes = std::size_t{1} * panels.rows.nodes * panels.columns.nodes *
                          panels.down.nodes * panels.across.nodes;
      ASSERT_EQ(panels.values.size(), 3u);
      for (const std::vector<float>& plane : panels.values) {
        EXPECT_EQ(plane.size(), nodes) << panels.name;
        EXPECT_TRUE(std::ranges::all_of(plane, [](float x) {
          return std::isfinite(x) && x >= 0;
        })) << panels.name;
      }
      if (panels.columns.nodes > 1) {
        EXPECT_EQ(panels.columns.labels.back(), "sun 90.0 deg");
        EXPECT_EQ(panels.rows.labels.front(), "0 km");
      }
    }
  }
}

TEST(Bruneton, ThePictureOfItsViewHasTheSkyAboveAndTheSunAtTheLeft) {
  Panels view = device().table_panels(hazy(0, 5, std::nullopt, small_tables())).back();
  const std::vector<float>& red = view.values.front();
  EXPECT_GT(red.front(), 100 * red.back());  // from 0 km nothing lies below
  std::size_t row = (view.down.nodes / std::size_t{2} - 8) * view.across.nodes;
  EXPECT_GT(red[row], 1.2 * red[row + view.across.nodes - 1]);
}

TEST(Bruneton, RefusesTablesThatTheDeviceCannotBind) {
  MethodOptions options =
      with_options({{"altitudes", 128}, {"zeniths", 128}, {"suns", 256}, {"azimuths", 65}});
  try {
    radiance(hazy(0, 30, std::nullopt, options), {{90, 0}});
    FAIL() << "a table of 8 GiB was made";
  } catch (const OverLimit& e) {
    EXPECT_EQ(e.pointer.rfind("/method/", 0), 0u) << e.pointer;
  }
}

}  // namespace
}  // namespace cyanometer
