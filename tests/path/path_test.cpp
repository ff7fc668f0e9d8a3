// Path tracing on the device against published radiances, a closed form, conservation of
// energy, and the standard errors that it states itself.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/gauss_legendre.h"
#include "tests/device.h"
#include "tests/oracle/scenes.h"
#include "tests/path/statistics.h"
#include "tests/path/walks.h"

namespace cyanometer {
namespace {

using oracle::reference_scene;
using oracle::towards;

constexpr double incident = 1;
constexpr int slices = 64;  // of 1024 walks and more

void set_walks(Scene& scene, int walks, int seed) {
  scene.method.name = "path";
  scene.method.options = {{"samples_per_pixel", walks}, {"seed", seed}};
}

/// The shell of Earth's air, haze and ozone of the tests, all orders.
Scene earth(double altitude_km, double sun_elevation_deg, int walks, int seed = 0) {
  Scene scene = reference_scene(altitude_km, sun_elevation_deg, 0.3);
  scene.method.scattering_orders.reset();
  set_walks(scene, walks, seed);
  return scene;
}

/// One layer of one constituent over a planet as good as flat, at one wavelength.
Scene flat(const Constituent& layer, double ground_albedo, double sun_zenith_deg) {
  Scene scene = reference_scene(0, 90 - sun_zenith_deg, ground_albedo);
  scene.planet.radius_km = 1e6;
  scene.atmosphere.constituents = {{"layer", layer}};
  scene.spectrum = {{550}, Colour::cie};
  scene.method.scattering_orders.reset();
  return scene;
}

Constituent molecules(const Profile& profile, double column_km, double optical_depth) {
  return {profile,
          Molecules{ScatteringCoefficient{PerWavelength{{optical_depth / column_km}}}}};
}

std::vector<Direction> spread(int count, double lowest_deg, double highest_deg) {
  std::vector<Direction> directions;
  for (int i = 0; i < count; ++i) {
    directions.push_back({lowest_deg + (highest_deg - lowest_deg) * (i + 0.5) / count,
                          std::fmod(137.50776 * i, 360) - 180});
  }
  return directions;
}

TEST(PathTracing, AgreesWithPublishedRayleighAirOfAllOrdersWithinItsStandardErrors) {
  nlohmann::json reference = oracle::published("discrete_ordinates.json");
  Deviations deviations;
  int seed = 0;
  for (const auto& c : reference["cases"]) {
    bool uniform = seed % 2 == 0;
    Profile profile = uniform ? Profile{UniformProfile{}} : Profile{ExponentialProfile{8}};
    double column = uniform ? 100 : 8 * (1 - std::exp(-100 / 8.0));
    Scene scene =
        flat(molecules(profile, column, c["tau"]), c["ground_albedo"], c["sun_zenith_deg"]);
    for (bool from_top : {false, true}) {
      set_walks(scene, 1024, ++seed);
      scene.camera.altitude_km = from_top ? scene.atmosphere.thickness_km : 0;
      std::vector<Direction> directions;
      for (const auto& row : c["rows"]) {
        double zenith = row[0];
        directions.push_back({from_top ? zenith - 90 : 90 - zenith, row[1]});
      }
      Radiances found = device().radiance(scene, directions, false);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        deviations.add(found.radiance[i][0], c["rows"][i][from_top ? 3 : 2],
                       (*found.standard_error)[i][0]);
      }
    }
  }
  expect_normal(deviations, slices);
}

/// Chandrasekhar's H function of isotropic scattering, by iteration of its integral equation
/// [Radiative Transfer 1960, chapter V, eq. 15, in the form 1 / H = sqrt(1 - w) + (w / 2)
/// int_0^1 x H(x) / (mu + x) dx, eq. 23].
class IsotropicH {
 public:
  explicit IsotropicH(double albedo) : albedo_(albedo), h_(points, 1.0) {
    for (int iteration = 0; iteration < 200; ++iteration) {
      std::vector<double> next(points);
      for (int i = 0; i < points; ++i) next[i] = (*this)(node(i));
      h_ = next;
    }
  }
  double operator()(double mu) const {
    double sum = 0;
    for (int i = 0; i < points; ++i) sum += node(i) * h_[i] / (mu + node(i)) / points;
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }

 private:
  static constexpr int points = 400;
  static double node(int i) { return (i + 0.5) / points; }
  double albedo_;
  std::vector<double> h_;
};

TEST(PathTracing, OfAThickIsotropicLayerIsChandrasekharsDiffuseReflection) {
  constexpr double albedo = 0.9, depth = 30, sun_zenith_deg = 48;
  IsotropicH h(albedo);
  double mu_sun = std::cos(glm::radians(sun_zenith_deg));
  Constituent layer{
      UniformProfile{},
      Particles{ParticleCoefficients{albedo * depth / 100, (1 - albedo) * depth / 100},
                HenyeyGreenstein{0}}};
  Scene scene = flat(layer, 0, sun_zenith_deg);
  scene.camera.altitude_km = scene.atmosphere.thickness_km;
  set_walks(scene, 2048, 5);
  std::vector<Direction> directions = spread(60, -88, -5);
  Radiances found = device().radiance(scene, directions, false);
  Deviations deviations;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    double mu = -std::sin(glm::radians(directions[i].elevation_deg));
    double expected =
        albedo / (4 * std::numbers::pi) * mu_sun / (mu + mu_sun) * h(mu) * h(mu_sun) * incident;
    deviations.add(found.radiance[i][0], expected, (*found.standard_error)[i][0]);
  }
  expect_normal(deviations, slices);
}

/// What leaves the top of the air: a Gauss rule in the zenith cosine and six azimuths, which
/// are exact for Rayleigh scattering. With its standard error.
std::pair<double, double> flux_to_space(const Scene& scene) {
  static const GaussRule rule = gauss_legendre(16);
  constexpr int azimuths = 6;
  std::vector<Direction> directions;
  std::vector<double> weights;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    double mu = rule.nodes[k];
    for (int a = 0; a < azimuths; ++a) {
      directions.push_back({-glm::degrees(std::asin(mu)), 360.0 * a / azimuths - 180});
      weights.push_back(rule.weights[k] * mu * 2 * std::numbers::pi / azimuths);
    }
  }
  Radiances found = device().radiance(scene, directions, false);
  double flux = 0, variance = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    flux += weights[i] * found.radiance[i][0];
    variance += std::pow(weights[i] * (*found.standard_error)[i][0], 2);
  }
  return {flux, std::sqrt(variance)};
}

TEST(PathTracing, WithoutAbsorptionReturnsAllTheLightToSpace) {
  for (double depth : {0.1, 1.0, 4.0}) {
    for (double sun_zenith_deg : {0.0, 60.0}) {
      Scene scene = flat(molecules(UniformProfile{}, 100, depth), 1, sun_zenith_deg);
      scene.camera.altitude_km = scene.atmosphere.thickness_km;
      set_walks(scene, 1024, 3);
      auto [flux, error] = flux_to_space(scene);
      double expected = std::cos(glm::radians(sun_zenith_deg)) * incident;
      // The rule is worth 1e-3; 3.3 standard errors are passed by one result in a thousand.
      EXPECT_NEAR(flux, expected, 3.3 * error + 1e-3 * expected)
          << "optical depth " << depth << ", sun " << sun_zenith_deg;
      EXPECT_LT(error, 0.01 * expected);
    }
  }
}

TEST(PathTracing, OfMoreOrdersIsNeverDarker) {
  std::vector<Direction> directions = spread(40, -60, 88);
  std::vector<std::vector<double>> fewer;
  for (int orders : {1, 2, 3, 4, 8, 30, -1}) {
    Scene scene = earth(1, 10, 256);
    if (orders > 0) scene.method.scattering_orders = orders;
    std::vector<std::vector<double>> more =
        device().radiance(scene, directions, false).radiance;
    for (std::size_t i = 0; i < fewer.size(); ++i) {
      for (int w = 0; w < 3; ++w) EXPECT_GE(more[i][w], fewer[i][w] * (1 - 1e-6)) << orders;
    }
    fewer = more;
  }
}

TEST(PathTracing, OfSixteenOrdersIsNearlyThatOfAll) {
  // In this air an order is at most some 0.6 of the one before: 0.6^16 is 3e-4.
  std::vector<Direction> directions = spread(20, -60, 88);
  Scene scene = earth(0.002, 30, 1024);
  auto all = device().radiance(scene, directions, false).radiance;
  scene.method.scattering_orders = 16;
  auto most = device().radiance(scene, directions, false).radiance;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (int w = 0; w < 3; ++w) EXPECT_NEAR(most[i][w], all[i][w], 1e-3 * all[i][w]);
  }
}

/// Light of a low sun comes through thick haze by many small turns: noise 0.068. While each of
/// them might go to the sky's brightest parts instead it was 0.110.
TEST(PathTracing, FollowsForwardPeaksThroughHazeUnderALowSun) {
  Scene scene = earth(0, 5, 1024);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2},
      Particles{ParticleOpticalDepth{1.0, 1.0}, HenyeyGreenstein{0.8}}};
  Radiances found = device().radiance(scene, spread(24, 2, 80), false);
  double logarithms = 0;
  for (std::size_t i = 0; i < found.radiance.size(); ++i)
    logarithms += std::log((*found.standard_error)[i][1] / found.radiance[i][1]);
  EXPECT_LT(std::exp(logarithms / 24), 0.085);
}

TEST(PathTracing, StatesStandardErrorsByWhichSeedsDiffer) {
  std::vector<Direction> directions = spread(100, -60, 88);
  Deviations deviations;
  for (double sun : {45.0, 3.0}) {
    Radiances a = device().radiance(earth(0.5, sun, 1024, 1), directions, false);
    Radiances b = device().radiance(earth(0.5, sun, 1024, 2), directions, false);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      deviations.add(a.radiance[i][1], b.radiance[i][1],
                     std::hypot((*a.standard_error)[i][1], (*b.standard_error)[i][1]));
    }
  }
  expect_normal(deviations, 2 * slices, 0.3);
}

TEST(PathTracing, InFloatOnTheDeviceAgreesWithDoubleWithinTheirStandardErrors) {
  constexpr int walks = 1024;
  std::vector<Direction> directions = spread(18, -60, 88);
  Deviations deviations;
  for (double altitude_km : {0.002, 10.0}) {
    for (double sun : {60.0, 8.0, -2.0, -6.0}) {
      Scene scene = earth(altitude_km, sun, walks, 3);
      Radiances all = device().radiance(scene, directions, false);
      scene.method.scattering_orders = 1;
      Radiances first = device().radiance(scene, directions, false);
      Problem problem =
          make_problem(earth(altitude_km, sun, walks), scene.spectrum.wavelengths_nm);
      Walks in_double(problem, 4);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        auto ray = static_cast<std::uint32_t>(i);
        double sum = 0, squares = 0;
        for (std::uint32_t k = 0; k < walks; ++k) {
          double light = in_double.walk(
              towards(directions[i].elevation_deg, directions[i].azimuth_deg), ray, k)[1];
          sum += light;
          squares += light * light;
        }
        double mean = sum / walks,
               error = std::sqrt(std::max(squares / walks - mean * mean, 0.0) / (walks - 1));
        deviations.add(all.radiance[i][1] - first.radiance[i][1], mean,
                       std::hypot((*all.standard_error)[i][1], error));
      }
    }
  }
  expect_normal(deviations, slices, 0.3);
}

TEST(PathTracing, DoesNotDependOnHowItsWorkIsCut) {
  Scene scene = earth(0.5, 4, 9);
  scene.sun.disc_samples = 3;
  std::vector<Direction> directions = spread(300, -80, 80);
  Engine slicing({.device = "", .longest_dispatch_ms = 1e-4});
  Radiances sliced = slicing.radiance(scene, directions, false);
  Radiances whole = device().radiance(scene, directions, false);
  EXPECT_EQ(sliced.radiance, whole.radiance);
  EXPECT_EQ(sliced.standard_error, whole.standard_error);
}

TEST(PathTracing, OfASunFarAwayIsThatOfParallelLight) {
  std::vector<Direction> directions = spread(40, -60, 88);
  Scene scene = earth(0.5, 20, 1024);
  Radiances parallel = device().radiance(scene, directions, false);
  scene.sun.distance_km = 1.5e8;
  Radiances far = device().radiance(scene, directions, false);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    EXPECT_NEAR(far.radiance[i][1], parallel.radiance[i][1],
                1e-3 * parallel.radiance[i][1] + (*parallel.standard_error)[i][1]);
  }
}

TEST(PathTracing, UnderOneWavelengthOfManyIsWhatItIsAlone) {
  std::vector<Direction> directions = spread(100, 2, 88);
  Scene scene = earth(0.002, 25, 1024, 8);
  Deviations deviations;
  Radiances many = device().radiance(scene, directions, false);
  scene.atmosphere.constituents["air"] = {
      ExponentialProfile{8}, Molecules{ScatteringCoefficient{PerWavelength{{0.0331}}}}};
  scene.atmosphere.constituents["ozone"] = {
      TentProfile{25, 15}, Absorber{AbsorptionCoefficient{PerWavelength{{8.5e-05}}}}};
  scene.spectrum = {{440}, Colour::cie};
  set_walks(scene, 1024, 9);
  Radiances alone = device().radiance(scene, directions, false);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    deviations.add(many.radiance[i][2], alone.radiance[i][0],
                   std::hypot((*many.standard_error)[i][2], (*alone.standard_error)[i][0]));
  }
  expect_normal(deviations, 2 * slices, 0.3);
}

TEST(PathTracing, OfATabulatedPhaseIsThatOfTheFormulaInIt) {
  Scene scene = earth(0.002, 25, 1024, 1);
  constexpr double g = 0.7;
  PhaseTable table;
  for (int i = 0; i <= 720; ++i) {
    double angle = i * 0.25, cosine = std::cos(glm::radians(angle));
    table.angle_deg.push_back(angle);
    table.values.push_back(std::pow(1 + g * g - 2 * g * cosine, -1.5));
  }
  std::vector<Direction> directions = spread(100, -60, 88);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2}, Particles{ParticleCoefficients{0.2, 0.01}, HenyeyGreenstein{g}}};
  Radiances formula = device().radiance(scene, directions, false);
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2}, Particles{ParticleCoefficients{0.2, 0.01}, table}};
  set_walks(scene, 1024, 2);
  Radiances tabulated = device().radiance(scene, directions, false);
  Deviations deviations;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    deviations.add(
        tabulated.radiance[i][1], formula.radiance[i][1],
        std::hypot((*tabulated.standard_error)[i][1], (*formula.standard_error)[i][1]));
  }
  expect_normal(deviations, 2 * slices, 0.3);
}

TEST(PathTracing, OfALargeSunIsTheMeanOverItsDisc) {
  Scene scene = earth(0.002, 12, 1024, 1);
  scene.sun.angular_diameter_deg = 20;
  scene.sun.limb_darkening = false;
  scene.sun.disc_samples = 4;
  std::vector<Direction> directions = spread(60, -60, 88);
  Radiances disc = device().radiance(scene, directions, false);
  Physics<double> physics = pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm));
  std::vector<double> mean(directions.size(), 0.0), variance(directions.size(), 0.0);
  scene.sun.disc_samples = 1;
  for (int k = 0; k < 4; ++k) {
    set_walks(scene, 1024, 2 + k);
    glm::dvec3 d = physics.sun_ray(glm::dvec3(0), physics.sun_offset(k)).direction;
    double share = physics.sun_weight(k, 0).y;
    scene.sun.elevation_deg = glm::degrees(std::asin(d.z));
    scene.sun.azimuth_deg = glm::degrees(std::atan2(d.x, d.y));
    Radiances point = device().radiance(scene, directions, false);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      mean[i] += point.radiance[i][1] * share;
      variance[i] += std::pow((*point.standard_error)[i][1] * share, 2);
    }
  }
  Deviations deviations;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    deviations.add(disc.radiance[i][1], mean[i],
                   std::sqrt(std::pow((*disc.standard_error)[i][1], 2) + variance[i]));
  }
  expect_normal(deviations, 2 * slices, 0.3);
}

/// A layer far above all that scatters, under a sun so high that all light passes it once.
TEST(PathTracing, StandardErrorsAreAsLargeAShareOfNextToNoLight) {
  const auto shares = [](double depth) {
    Scene scene = earth(0, 90, 256);
    scene.atmosphere.constituents["ozone"] = {TentProfile{95, 2},
                                              Absorber{AbsorptionCoefficient{depth / 2}}};
    const Radiances seen = device().radiance(scene, spread(8, 20, 85), false);
    double sum = 0;
    for (std::size_t i = 0; i < seen.radiance.size(); ++i)
      sum += (*seen.standard_error)[i][0] / seen.radiance[i][0];
    return sum / static_cast<double>(seen.radiance.size());
  };
  EXPECT_NEAR(shares(60) / shares(0), 1, 0.3);  // exp(-60): its square is none in a float
}

}  // namespace
}  // namespace cyanometer
