// The densities that the walks of shaders/methods/path/ state are those that they draw with.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/oracle/scenes.h"
#include "tests/path/statistics.h"
#include "tests/path/walks.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

/// A phase function in a table: a forward peak, a rainbow and a glory.
TabulatedPhase peaked_table() {
  TabulatedPhase table;
  table.values.resize(1);
  for (int i = 0; i <= 180; ++i) {
    double angle = glm::radians(static_cast<double>(i));
    table.angle_rad.push_back(angle);
    table.values[0].push_back(0.05 + 30 * std::exp(-angle / 0.05) +
                              std::exp(-std::pow((angle - 2.4) / 0.05, 2)) +
                              std::exp((angle - std::numbers::pi) / 0.02));
  }
  double sum = 0;
  for (std::size_t i = 0; i + 1 < table.angle_rad.size(); ++i) {
    sum += (std::cos(table.angle_rad[i]) - std::cos(table.angle_rad[i + 1])) *
           std::numbers::pi * (table.values[0][i] + table.values[0][i + 1]);
  }
  for (double& value : table.values[0]) value /= sum;
  return table;
}

/// A shell of one constituent for each phase function, at one wavelength.
Problem shell(const std::vector<PhaseFunction>& phases, double sun_elevation_deg) {
  Scene scene = oracle::reference_scene(0, sun_elevation_deg, 0.3);
  Problem problem = make_problem(scene, {550});
  problem.media.clear();
  double scale_height_km = 8;
  for (const PhaseFunction& phase : phases) {
    problem.media.push_back({"m", ExponentialProfile{scale_height_km}, {0.02}, {0.001}, phase});
    scale_height_km /= 3;
  }
  problem.scattering_orders = -1;
  return problem;
}

const std::vector<PhaseFunction>& all_phases() {
  static const std::vector<PhaseFunction> phases{RayleighPhase{{0.02}}, HenyeyGreenstein{0.7},
                                                 HenyeyGreenstein{-0.6}, CornetteShanks{0.9},
                                                 peaked_table()};
  return phases;
}

P::ScatteringAngle angle_of_deflection(double deflection) {
  return {1 - deflection, deflection, 2 - deflection};
}

TEST(Proposals, DrawDeflectionsWithTheDensityThatTheyState) {
  constexpr int draws = 100000;
  Walks walks(shell(all_phases(), 45));
  P& p = walks.physics();
  for (int c = 0; c < p.MEDIA; ++c) {
    for (double edge : {0.001, 0.01, 0.1, 0.5, 1.0, 1.5, 1.9}) {
      int below = 0;
      double integral = 0;
      for (int i = 0; i < draws; ++i) {
        double u = (i + 0.5) / draws;
        below += p.proposed_deflection(c, u) < edge;
        // Of the cube, so that the peak has points enough.
        double x = u * u * u * edge, width = 3 * u * u * edge / draws;
        integral += 2 * std::numbers::pi * p.proposed_phase(c, angle_of_deflection(x)) * width;
      }
      EXPECT_NEAR(static_cast<double>(below) / draws, integral, 1e-3)
          << "constituent " << c << ", 1 - cos below " << edge;
    }
  }
}

/// Uniform numbers that have nothing to do with those of the walks.
class Numbers {
 public:
  double next() { return uniform_(engine_); }
  glm::dvec4 four() { return {next(), next(), next(), next()}; }

 private:
  std::mt19937_64 engine_{12345};
  std::uniform_real_distribution<double> uniform_{1e-12, 1 - 1e-12};
};

/// Mean of values and its standard error.
struct Mean {
  double sum = 0, squares = 0;
  int count = 0;

  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double value() const { return sum / count; }
  double error() const {
    return std::sqrt(std::max(squares / count - value() * value(), 0.0) / (count - 1));
  }
};

TEST(Proposals, DrawDirectionsWithTheDensityThatTheyState) {
  // The mean of 1 / density over the draws in a part of the sphere is its solid angle.
  constexpr int draws = 40000, parts = 12;
  Deviations deviations;
  Numbers numbers;
  for (double sun_elevation_deg : {40.0, -1.0, -8.0}) {
    Walks walks(shell(all_phases(), sun_elevation_deg));
    P& p = walks.physics();
    glm::dvec3 sun = oracle::towards(sun_elevation_deg, 30);
    double share[P::MEDIA_SIZE] = {0.3, 0.2, 0.1, 0.2, 0.2};
    for (bool ground : {false, true}) {
      P::Scatterer scatterer{ground, oracle::towards(ground ? -20 : 15, 200), {}};
      P::Aim aim = p.aim_at(sun, ground ? 0 : 5, sun_elevation_deg > 0 ? 0.8 : 0.0,
                            ground ? 1 : p.scattered_widely(share));
      std::vector<Mean> solid_angle(parts);
      for (int i = 0; i < draws; ++i) {
        glm::dvec4 u = numbers.four();
        glm::dvec3 d = p.choose_direction(scatterer, aim, sun, share, u);
        double density = p.direction_density(scatterer, aim, sun, share, d);
        int part = std::min(static_cast<int>((d.z + 1) / 2 * parts), parts - 1);
        for (int k = 0; k < parts; ++k) solid_angle[k].add(k == part ? 1 / density : 0);
      }
      // The ground's own proposal is blind to what is below the horizon.
      bool all_around = !ground || aim.sky > 0;
      for (int k = all_around ? 0 : parts / 2; k < parts; ++k) {
        deviations.add(solid_angle[k].value(), 4 * std::numbers::pi / parts,
                       solid_angle[k].error());
      }
    }
  }
  expect_normal(deviations, draws, 0.5);
}

TEST(Proposals, DrawDistancesWithTheDensityThatTheyState) {
  // The mean of 1 / density over the draws in a part of a ray is its length.
  constexpr int draws = 20000, parts = 8;
  Deviations deviations;
  Numbers numbers;
  for (double sun_elevation_deg : {40.0, -6.0}) {
    Walks walks(shell(all_phases(), sun_elevation_deg));
    P& p = walks.physics();
    for (double h : {0.0, 3.0, 60.0}) {
      for (double elevation_deg : {80.0, 4.0, -1.0, -4.0, -50.0}) {
        glm::dvec3 direction = oracle::towards(elevation_deg, 40);
        P::Walk walk{h, direction, oracle::towards(sun_elevation_deg, 0), 0, 1, {}, {}};
        P::Leg leg = p.leg_from(h, direction.z, P::ENDLESS);
        double length_km = leg.back_km + leg.on_km;
        if (length_km <= 0) continue;
        glm::dvec4 throughput[P::GROUPS_SIZE] = {glm::dvec4(1, 0, 0, 0)};
        std::vector<Mean> parts_km(parts);
        Mean ground;
        double ground_probability = 0;
        for (int i = 0; i < draws; ++i) {
          glm::dvec4 u = numbers.four();
          P::Flight flight = p.choose_flight(walk, leg, throughput, u);
          bool in_air = !flight.ends && !flight.ground;
          ground.add(flight.ground);
          if (flight.ground) ground_probability = flight.density;
          // Parts that are shorter near the walk, where the density is large.
          double x = std::sqrt(flight.distance_km / length_km);
          int part = std::min(static_cast<int>(x * parts), parts - 1);
          for (int k = 0; k < parts; ++k) {
            parts_km[k].add(in_air && k == part ? 1 / flight.density : 0);
          }
        }
        for (int k = 0; k < parts; ++k) {
          // Thin air far away is hardly ever drawn: too few draws to be normal.
          if (parts_km[k].error() > 0.1 * parts_km[k].value()) continue;
          deviations.add(parts_km[k].value(), length_km * (2 * k + 1) / (parts * parts),
                         parts_km[k].error());
        }
        if (ground.error() > 0)
          deviations.add(ground.value(), ground_probability, ground.error());
      }
    }
  }
  EXPECT_GT(deviations.z.size(), 100u);
  expect_normal(deviations, draws, 0.5);
}

TEST(Proposals, NumbersOfAStreamFillTheUnitIntervalEvenly) {
  Walks walks(shell(all_phases(), 45));
  P& p = walks.physics();
  constexpr int count = 1 << 16, bins = 64;
  for (int lane = 0; lane < 4; ++lane) {
    std::vector<int> found(bins * bins, 0);
    for (int i = 0; i < count; ++i) {
      P::Stream stream{7, static_cast<std::uint32_t>(i), 3};
      double u = p.uniform_numbers(stream, 2)[lane], v = p.uniform_numbers(stream, 3)[lane];
      ASSERT_GT(u, 0);
      ASSERT_LT(u, 1);
      ++found[static_cast<int>(u * bins) * bins + static_cast<int>(v * bins)];
    }
    double chi_square = 0, expected = static_cast<double>(count) / (bins * bins);
    for (int n : found) chi_square += (n - expected) * (n - expected) / expected;
    // 4095 degrees of freedom; passed on either side by one in a thousand.
    EXPECT_NEAR(chi_square, bins * bins - 1, 3.3 * std::sqrt(2.0 * bins * bins));
  }
}

}  // namespace
}  // namespace cyanometer
