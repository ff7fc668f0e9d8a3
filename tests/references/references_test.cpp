// The two references against each other: random walks, and moment tables in double,
// extrapolated to zero spacing. They share the physics' formulas (scene, optics, order one) and
// nothing of how the orders after the first are found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/engine.h"
#include "engine/scene/document.h"
#include "tests/moments/reference.h"
#include "tests/oracle/scenes.h"

namespace cyanometer {
namespace {

using oracle::towards;
using Samples = std::vector<glm::dvec4>;

/// All that has a spacing grows by the factor; directions also have to tell the moments apart.
ReferenceSizes sizes(int degree, double factor) {
  auto of = [&](int usual) { return static_cast<int>(std::lround(usual * factor)); };
  return {.degree = degree,
          .altitudes = of(10),
          .suns = of(20),
          .up = of(6) + degree,
          .down = of(3) + degree,
          .azimuths = of(3) + degree,
          .steps = of(8),
          .first_steps = of(9),
          .orders = 6,
          .view_steps = of(24)};
}

std::vector<Direction> directions() {
  std::vector<Direction> all;
  for (double elevation : {80.0, 30.0, 10.0, 3.0, -4.0, -45.0}) {
    for (double azimuth : {10.0, 60.0, 100.0, 170.0}) all.push_back({elevation, azimuth});
  }
  return all;
}

Problem problem_of(Scene scene, double sun_elevation_deg) {
  scene.sun.elevation_deg = sun_elevation_deg;
  return make_problem(scene, scene.spectrum.wavelengths_nm);
}

/// Light scattered more than once, in all directions under one sun.
Samples by_tables(MomentReference& tables, const Problem& problem) {
  Samples all;
  for (const Direction& d : directions()) {
    all.push_back(tables.further_radiance(problem, towards(d.elevation_deg, d.azimuth_deg)));
  }
  return all;
}

/// Air that scatters as molecules do, with ozone: two moments hold all of it.
Scene clear_air() {
  Scene scene = oracle::reference_scene(0, 40, 0.3);
  scene.atmosphere.constituents.erase("aerosol");
  return scene;
}

/// What the tables come to with no spacing at all, from two spacings, one half of the other:
/// their cubics leave an error of the fourth order.
struct Extrapolated {
  Samples radiance;
  double step = 0;  ///< largest relative difference of the two
};

class Tables {
 public:
  Tables(const Scene& scene, int degree, double factor)
      : coarse_(problem_of(scene, 40), sizes(degree, factor)),
        fine_(problem_of(scene, 40), sizes(degree, 2 * factor)) {}

  Extrapolated at(const Problem& problem) {
    Samples coarse = by_tables(coarse_, problem), fine = by_tables(fine_, problem);
    Extrapolated found{fine, 0};
    for (std::size_t i = 0; i < fine.size(); ++i) {
      for (int w = 0; w < 3; ++w) {
        double step = fine[i][w] - coarse[i][w];
        found.step = std::max(found.step, std::abs(step) / fine[i][w]);
        found.radiance[i][w] += step / 15;
      }
    }
    return found;
  }

 private:
  MomentReference coarse_, fine_;
};

/// Differences of random walks from the extrapolated tables.
struct Difference {
  double mean_z = 0, mean_square_z = 0;                         ///< in standard errors
  double mean = 0, largest_beyond_noise = 0, median_error = 0;  ///< over the radiance
};

Difference compare(const Scene& scene, double sun, const Extrapolated& tables, int walks) {
  static Engine engine;
  Scene walked = scene;
  walked.sun.elevation_deg = sun;
  walked.method = {};
  walked.method.name = "path";
  walked.method.options = {{"samples_per_pixel", walks}, {"seed", 1}};
  Radiances path = engine.radiance(walked, directions(), false);
  oracle::Adaptive first(pack<double>(problem_of(scene, sun)), 1e-7);
  Difference all;
  std::vector<double> errors;
  for (std::size_t i = 0; i < directions().size(); ++i) {
    auto [elevation, azimuth] = directions()[i];
    oracle::Ray one = first.trace(towards(elevation, azimuth));
    for (int w = 0; w < 3; ++w) {
      double expected = one.inscatter[w] + one.ground[w] + tables.radiance[i][w];
      double error = (*path.standard_error)[i][w], d = path.radiance[i][w] - expected;
      all.mean_z += d / error;
      all.mean_square_z += d * d / (error * error);
      all.mean += d / expected;
      all.largest_beyond_noise =
          std::max(all.largest_beyond_noise, (std::abs(d) - 3.5 * error) / expected);
      errors.push_back(error / expected);
    }
  }
  std::sort(errors.begin(), errors.end());
  double count = static_cast<double>(errors.size());
  all.mean_z /= count;
  all.mean_square_z /= count;
  all.mean /= count;
  all.median_error = errors[errors.size() / 2];
  std::printf(
      "sun %5.1f: tables' step %.1e; walks: median standard error %.1e, mean z %.2f, mean "
      "z^2 %.2f, mean difference %.1e, largest beyond noise %.1e\n",
      sun, tables.step, all.median_error, all.mean_z, all.mean_square_z, all.mean,
      all.largest_beyond_noise);
  return all;
}

/// The bound is a share of the radiance.
void expect_agreement(const Difference& d, double bound) {
  EXPECT_LT(std::abs(d.mean), bound);
  EXPECT_LT(d.largest_beyond_noise, bound);
}

/// Of 72 values, of which wavelengths share walks.
void expect_nothing_but_noise(const Difference& d) {
  EXPECT_LT(std::abs(d.mean_z), 0.5);
  EXPECT_LT(d.mean_square_z, 2);
}

TEST(References, AgreeWithinAPermilleByDayAndFiveInTwilight) {
  Tables tables(clear_air(), 2, 1);
  for (double sun : {60.0, 15.0, 3.0, -3.0, -6.0, -9.0}) {
    Extrapolated expected = tables.at(problem_of(clear_air(), sun));
    Difference d = compare(clear_air(), sun, expected, 1 << 18);
    expect_agreement(d, sun > 0 ? 1e-3 : 5e-3);
    expect_nothing_but_noise(d);
  }
}

/// Eight degrees hold the aerosol's peak; six leave 1.3e-3 of it beyond noise near a low sun.
TEST(References, AgreeWithinAPermilleUnderAThinAerosol) {
  Scene scene = oracle::reference_scene(0, 40, 0.3);
  Tables tables(scene, 8, 1);
  for (double sun : {60.0, 15.0}) {
    expect_agreement(compare(scene, sun, tables.at(problem_of(scene, sun)), 1 << 18), 1e-3);
  }
}

TEST(References, AgreeToHalfAPermilleWhereWalksAreMany) {
  Tables tables(clear_air(), 2, 1);
  Difference d = compare(clear_air(), 60, tables.at(problem_of(clear_air(), 60)), 1 << 21);
  EXPECT_LT(d.median_error, 5e-4);
  expect_agreement(d, 2e-4);
  expect_nothing_but_noise(d);
}

/// |d| of the contract's measure between a method and the extrapolated tables, ascending.
std::vector<double> differences(const std::string& method, double sun,
                                const Extrapolated& tables) {
  static Engine engine;
  Scene scene = clear_air();
  scene.sun.elevation_deg = sun;
  scene.method = {};
  scene.method.name = method;
  for (const MethodDescription& each : methods()) {
    if (each.name != method) continue;
    for (const MethodOption& option : each.options) {
      scene.method.options[option.name] = option.default_value;
    }
  }
  oracle::Adaptive first(pack<double>(problem_of(scene, sun)), 1e-6);
  std::vector<std::vector<double>> expected;
  for (std::size_t i = 0; i < directions().size(); ++i) {
    auto [elevation, azimuth] = directions()[i];
    oracle::Ray one = first.trace(towards(elevation, azimuth));
    expected.emplace_back();
    for (int w = 0; w < 3; ++w) {
      expected.back().push_back(one.inscatter[w] + one.ground[w] + tables.radiance[i][w]);
    }
  }
  auto d = relative_differences(engine.radiance(scene, directions(), false).radiance, expected);
  for (double& each : d) each = std::abs(each);
  std::sort(d.begin(), d.end());
  return d;
}

/// Share of values, and what they must not exceed.
struct Bound {
  const char* method;
  double sun, median, share, there;
};

TEST(References, BoundTheMethodsInClearAirDownToLateTwilight) {
  Tables tables(clear_air(), 2, 1.6);
  for (double sun : {60.0, 15.0, 3.0, -6.0, -12.0}) {
    Extrapolated expected = tables.at(problem_of(clear_air(), sun));
    bool day = sun > 0;
    std::vector<Bound> bounds{{"bruneton", sun, day ? 0.003 : 1, 0.99, sun < -6 ? 0.05 : 0.02}};
    if (sun >= -6) bounds.push_back({"moments", sun, day ? 0.002 : 1, 0.95, day ? 0.01 : 0.02});
    for (const Bound& bound : bounds) {
      auto d = differences(bound.method, sun, expected);
      auto at = [&](double share) {
        return d[static_cast<std::size_t>(share * static_cast<double>(d.size()))];
      };
      std::printf("sun %5.1f: %-8s median %.2e, %2.0f %% %.2e (tables' step %.1e)\n", sun,
                  bound.method, at(0.5), 100 * bound.share, at(bound.share), expected.step);
      EXPECT_LT(at(0.5), bound.median) << bound.method << sun;
      EXPECT_LT(at(bound.share), bound.there) << bound.method << sun;
    }
  }
}

}  // namespace
}  // namespace cyanometer
