// Parts of rays as differences of the tables, against integrals along those parts alone.
#include "engine/methods/bruneton/segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "engine/gauss_legendre.h"
#include "tests/bruneton/workshop.h"
#include "tests/oracle/adaptive.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

/// A ray's direction, and where its part ends.
struct Part {
  glm::dvec3 direction;
  double end_km;
};
using Values = std::vector<std::vector<double>>;  ///< [part][wavelength]

constexpr int wavelengths = 3;

/// Makes parts from tables of the default's nodes, or of so many times as many altitudes, views
/// and suns.
struct Bench : Workshop {
  explicit Bench(double times = 1)
      : setup(with_options({{"gather", 0},
                            {"first_order", 1},
                            {"altitudes", 16 * times},
                            {"zeniths", 24 * times},
                            {"suns", 32 * times},
                            {"samples", 20 * times}})) {}

  bruneton::Setup setup;
  bruneton::Segments segments{device};
};

Bench& with_defaults() {
  static Bench bench;
  return bench;
}

Problem problem_of(double altitude_km, double sun_deg, std::optional<int> orders) {
  return make_problem(hazy(altitude_km, sun_deg, orders, {}), {680, 550, 440});
}

/// Up, about the horizon and down, at several azimuths from the sun; those that are not over
/// before the distance.
std::vector<Part> parts_of(const Problem& problem, double end_km) {
  P p = pack<double>(problem);
  std::vector<Part> parts;
  for (double elevation_deg : {40.0, 8.0, 1.0, -0.5, -3.0, -12.0, -50.0}) {
    for (double azimuth_deg : {4.0, 50.0, 110.0, 175.0}) {
      glm::dvec3 direction = oracle::towards(elevation_deg, azimuth_deg);
      if (p.path_from_camera(direction).length_km > end_km)
        parts.push_back({direction, end_km});
    }
  }
  return parts;
}

Values by_difference(Bench& w, const Problem& problem, const std::vector<Part>& parts) {
  std::vector<glm::dvec3> directions;
  std::vector<float> ends_km;
  for (const Part& part : parts) {
    directions.push_back(part.direction);
    ends_km.push_back(static_cast<float>(part.end_km));
  }
  UploadedScene scene(w.device, problem, directions);
  vulkan::Buffer ends(w.device, ends_km.size() * sizeof(float), vulkan::Memory::device);
  ends.write(0, std::as_bytes(std::span(ends_km)));
  int rays = static_cast<int>(parts.size());
  vulkan::Buffer values(w.device, std::size_t{16} * 3 * rays, vulkan::Memory::host);
  w.segments.trace(w.tracer, w.maker, scene, w.setup, ends, {0, rays, values});
  Values found;
  for (const glm::vec4& four : values.as<const glm::vec4>().first(parts.size())) {
    found.push_back({four.x, four.y, four.z});
  }
  return found;
}

/// What is scattered in orders from the second on, from the very source that the tables have.
class Source {
 public:
  Source(Bench& w, const Problem& problem)
      : p_(pack<double>(problem)),
        columns_(p_),
        sun_{problem.sun_direction[0], problem.sun_direction[1], problem.sun_direction[2]} {
    UploadedScene scene(w.device, problem);
    auto tables = w.maker.source(w.tracer, scene, w.setup);
    const bruneton::ScatteringGrid& g = tables->grid;
    grid_ = {g.altitudes,  g.zeniths,    g.suns,      g.azimuths,  g.mapping,   g.two_sided,
             g.highest_mu, g.lowest_sun, g.sun_shift, g.sun_width, g.sun_first, g.sun_span};
    logs_.resize(tables->source.size() / sizeof(glm::vec4));
    tables->source.read(0, std::as_writable_bytes(std::span(logs_)));
  }

  std::vector<double> along(const Part& part) {
    static const GaussRule rule = gauss_legendre(8);
    constexpr int pieces = 12;
    std::vector<double> sum(wavelengths, 0.0);
    for (int piece = 0; piece < pieces; ++piece) {
      double from = part.end_km * std::pow(1.0 * piece / pieces, 2);
      double width = part.end_km * std::pow((1.0 + piece) / pieces, 2) - from;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        glm::dvec4 light = seen_from(part.direction, from + width * rule.nodes[k]);
        for (int c = 0; c < wavelengths; ++c) sum[c] += width * rule.weights[k] * light[c];
      }
    }
    return sum;
  }

 private:
  /// Radiance that the camera gets, a km.
  glm::dvec4 seen_from(const glm::dvec3& direction, double t) {
    P::Path path = p_.path_from_camera(direction), rest = p_.path_beyond(path, t);
    oracle::Adaptive::Columns column = columns_.column(path.altitude_km, path.mu, t);
    p_.densities(rest.altitude_km, density_);
    glm::dvec4 depth(0), coefficient(0);
    for (int c = 0; c < p_.MEDIA; ++c) {
      depth += p_.extinction(c, 0) * column[c];
      coefficient += p_.scattering(c, 0) * density_[c];
    }
    return glm::exp(-depth) * coefficient * glm::exp(log_at(rest));
  }

  glm::dvec4 log_at(const P::Path& ray) {
    double mu_s = glm::dot(ray.start, sun_) / glm::length(ray.start);
    double cos_azimuth = p_.azimuth_cosine(ray.mu, std::sqrt(1 - ray.mu * ray.mu), mu_s,
                                           glm::dot(ray.direction, sun_));
    const std::array<int, 4> nodes{grid_.altitudes, grid_.suns, grid_.zeniths, grid_.azimuths};
    const std::array<double, 4> at{
        p_.node_coordinate(p_.altitude_share(grid_, ray.altitude_km), nodes[0]),
        p_.node_coordinate(p_.sun_share(grid_, mu_s), nodes[1]),
        p_.node_coordinate(std::acos(ray.mu) / std::numbers::pi, nodes[2]),
        p_.node_coordinate(std::acos(cos_azimuth) / std::numbers::pi, nodes[3])};
    glm::dvec4 sum(0);
    for (int corner = 0; corner < 16; ++corner) {
      double weight = 1;
      std::size_t texel = 0;
      for (int d = 0; d < 4; ++d) {
        int low = std::min(static_cast<int>(at[d]), nodes[d] - 2), upper = corner >> d & 1;
        weight *= upper ? at[d] - low : 1 - at[d] + low;
        texel = texel * nodes[d] + low + upper;
      }
      sum += weight * glm::dvec4(logs_[texel]);
    }
    return sum;
  }

  P p_;
  oracle::Adaptive columns_;
  glm::dvec3 sun_;
  P::ScatteringGrid grid_{};
  std::vector<glm::vec4> logs_;
  double density_[P::MEDIA_SIZE] = {};
};

Values by_integral(Bench& w, const Problem& problem, const std::vector<Part>& parts) {
  oracle::Adaptive first(pack<double>(problem));
  std::optional<Source> source;
  if (bruneton::has_multiple(problem)) source.emplace(w, problem);
  Values exact;
  for (const Part& part : parts) {
    std::vector<double> sum = first.trace(part.direction, part.end_km).inscatter;
    sum.resize(wavelengths);
    if (source) {
      std::vector<double> more = source->along(part);
      for (int c = 0; c < wavelengths; ++c) sum[c] += more[c];
    }
    exact.push_back(sum);
  }
  return exact;
}

/// Over parts and wavelengths.
struct Errors {
  double median = 0, most = 0;  ///< relative
  int values = 0, negative = 0, not_finite = 0;
};

/// Relative differences, adding what the differences are of to `errors`.
void compare(const Values& found, const Values& exact, std::vector<double>& relative,
             Errors& errors) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (int c = 0; c < wavelengths; ++c) {
      errors.not_finite += !std::isfinite(found[i][c]);
      errors.negative += found[i][c] < 0;
      relative.push_back(std::abs(found[i][c] / exact[i][c] - 1));
    }
  }
}

/// From altitudes that lie anyhow between the tables' nodes.
Errors errors_of(Bench& w, double sun_deg, std::optional<int> orders, double end_km) {
  Errors errors;
  std::vector<double> relative;
  for (double altitude_km : {0.05, 0.3, 1.0, 2.3, 6.0}) {
    Problem problem = problem_of(altitude_km, sun_deg, orders);
    std::vector<Part> parts = parts_of(problem, end_km);
    compare(by_difference(w, problem, parts), by_integral(w, problem, parts), relative, errors);
  }
  std::ranges::sort(relative);
  errors.values = static_cast<int>(relative.size());
  errors.median = relative[relative.size() / 2];
  errors.most = relative.back();
  return errors;
}

Errors printed(Bench& w, double sun_deg, std::optional<int> orders, double end_km) {
  Errors e = errors_of(w, sun_deg, orders, end_km);
  std::printf("%s, sun %2g deg, %5g km: median %.2g, largest %.2g; %d of %d negative\n",
              orders ? "order 1" : "all orders", sun_deg, end_km, e.median, e.most, e.negative,
              e.values);
  return e;
}

const std::vector<double> ends_km{1e-3, 1e-2, 0.1, 1, 10, 100};

TEST(Segments, AreWithinPercentsOfTheIntegralByDay) {
  Bench& w = with_defaults();
  for (std::optional<int> orders : {std::optional(1), std::optional<int>()}) {
    for (double end_km : ends_km) {
      Errors e = printed(w, 30, orders, end_km);
      EXPECT_EQ(e.not_finite + e.negative, 0);
      EXPECT_LT(e.median, end_km < 100 ? 0.06 : 0.01);
      EXPECT_LT(e.most, end_km < 10 ? 0.9 : 0.15);
    }
  }
}

TEST(Segments, OfAllOrdersAreWithinATenthWithTheSunOnTheHorizonAndNeverNegative) {
  for (double end_km : ends_km) {
    Errors e = printed(with_defaults(), 0, std::nullopt, end_km);
    EXPECT_EQ(e.not_finite + e.negative, 0);
    EXPECT_LT(e.median, 0.1);
    EXPECT_LT(e.most, 1.01);
  }
}

TEST(Segments, OfTheFirstOrderAreSpoiltWithTheSunOnTheHorizon) {
  int negative = 0;
  for (double end_km : ends_km) {
    Errors e = printed(with_defaults(), 0, 1, end_km);
    EXPECT_EQ(e.not_finite, 0);
    EXPECT_LT(e.median, 0.3);
    EXPECT_GT(e.most, 1);
    negative += e.negative;
  }
  EXPECT_GT(negative, 0);
}

TEST(Segments, ConvergeToTheIntegral) {
  Bench coarse(0.5);
  for (double sun_deg : {30.0, 0.0}) {
    for (double end_km : {1e-2, 10.0}) {
      double of_coarse = printed(coarse, sun_deg, 1, end_km).median;
      EXPECT_LT(printed(with_defaults(), sun_deg, 1, end_km).median, 0.5 * of_coarse);
    }
  }
}

TEST(Segments, AsLongAsTheRayAreTheRay) {
  Bench& w = with_defaults();
  MethodOptions options = with_options({{"gather", 0}, {"first_order", 1}});
  Scene scene = hazy(1, 30, std::nullopt, options);
  Radiances whole = device().radiance(scene, {{40, 50}, {3, 170}}, false);
  Values found =
      by_difference(w, problem_of(1, 30, std::nullopt),
                    {{oracle::towards(40, 50), 1e4}, {oracle::towards(3, 170), 1e4}});
  for (int ray : {0, 1}) {
    for (int c = 0; c < wavelengths; ++c) {
      EXPECT_NEAR(found[ray][c], whole.radiance[ray][c], 1e-5 * whole.radiance[ray][c]);
    }
  }
}

TEST(Segments, HaveNoLightBeforeTheAir) {
  Bench& w = with_defaults();
  Problem problem = problem_of(400, 30, std::nullopt);
  glm::dvec3 down = oracle::towards(-60, 20);
  Values found = by_difference(w, problem, {{down, 300}, {down, 2000}});
  for (int c = 0; c < wavelengths; ++c) {
    EXPECT_LT(std::abs(found[0][c]), 1e-4 * found[1][c]);
  }
}

TEST(Segments, RefuseTablesOfOneCamera) {
  Bench w;
  w.setup.gathered_view = true;
  EXPECT_THROW(by_difference(w, problem_of(1, 30, 1), {{oracle::towards(10, 0), 1}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace cyanometer
