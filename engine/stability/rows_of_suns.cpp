// Rows about where the sun is: twilight, the planet's shadow, seams towards it, large suns.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/document.h"
#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;

json lit_from(json scene, double elevation_deg, double azimuth_deg = 0) {
  return changed(std::move(scene),
                 {{"sun", {{"elevation_deg", elevation_deg}, {"azimuth_deg", azimuth_deg}}}});
}

/// Twilight reaches higher than the usual top.
json tall_earth() { return changed(plain_scene(), {{"atmosphere", {{"thickness_km", 200}}}}); }

/// |f(x - step) - 2 f(x) + f(x + step)| of f = ln L, and of ln L1 taken off where the method
/// has but order one, whose shadow truly ends on a ray.
Measured bend(Trial& trial, double sun_deg, double step_deg) {
  const std::vector<Direction> zenith{{90, 0}};
  std::array<Radiances, 3> seen;
  std::array<std::vector<std::vector<double>>, 3> first;
  for (int i = 0; i < 3; ++i) {
    json scene = lit_from(tall_earth(), sun_deg + (i - 1) * step_deg);
    seen[i] = trial.look(scene, zenith);
    if (trial.first_order_only()) first[i] = trial.first_order(scene, zenith);
  }
  return largest(1, [&](std::size_t ray, std::size_t c) -> Measured {
    std::array<double, 3> logs{}, noise{};
    for (int i = 0; i < 3; ++i) {
      double value = seen[i].radiance[ray][c];
      noise[i] = noise_of(seen[i], ray, c) / value;
      if (trial.first_order_only()) {
        if (first[i][ray][c] < 1e-12) return 0;  // next to nothing, or nothing at all
        value /= first[i][ray][c];
      }
      logs[i] = std::log(value);
    }
    double all = together({noise[0], 2 * noise[1], noise[2]});
    return {std::max(std::abs(logs[0] - 2 * logs[1] + logs[2]) - all, 0.0), all};
  });
}

StabilityRow late_twilight() {
  StabilityRow row{.number = 7,
                   .name = "Late twilight",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "second difference of the log of the zenith's radiance over 0.1 "
                       "deg; order one is 0 where the sun lights nothing",
                   .bound = 0.01,
                   .sweep = {},
                   .hardest = -12};
  for (double sun = 0; sun >= -18; sun -= 1.5) row.sweep.push_back(sun);
  row.scene = [](double x) {
    return lit_from(changed(tall_earth(), {{"camera", {{"pitch_deg", 30}}}}), x);
  };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    if (x <= -12) {
      json dark = changed(lit_from(plain_scene(), x), {{"method", {{"scattering_orders", 1}}}});
      Radiances unlit = trial.look(dark, {{90, 0}});
      for (double value : unlit.radiance[0]) {
        if (value != 0) throw BrokenFrame("order one is not 0 in the planet's shadow");
      }
    }
    return {bend(trial, x, 0.1)};
  };
  return row;
}

/// No order takes light away. In twilight the second to the fourth may be brighter than the one
/// before, from which the planet's shadow hides the air that is seen; later ones are not.
void check_orders(const Trial& trial, const std::vector<Radiances>& up_to, std::size_t ray,
                  std::size_t c) {
  constexpr std::size_t first_to_fall = 5;
  constexpr double rounding = 1e-5;
  auto light = [&](std::size_t n) { return n > 0 ? up_to[n - 1].radiance[ray][c] : 0; };
  auto unsure = [&](std::size_t n) {
    if (n == 0) return 0.0;
    return noise_of(up_to[n - 1], ray, c) + (rounding + trial.stated(up_to[n - 1])) * light(n);
  };
  for (std::size_t n = 1; n <= up_to.size(); ++n) {
    double order = light(n) - light(n - 1);
    if (order < -together({unsure(n), unsure(n - 1)}))
      throw BrokenFrame("order " + std::to_string(n) + " is negative");
    if (n < first_to_fall) continue;
    double before = light(n - 1) - light(n - 2);
    if (order > before + together({unsure(n), 2 * unsure(n - 1), unsure(n - 2)}))
      throw BrokenFrame("order " + std::to_string(n) + " is brighter than the one before");
  }
}

/// L_all against L_n and the geometric series that its last two orders begin.
Measured series_gap(Trial& trial, double sun_deg) {
  constexpr int most = 9;
  auto rays = fan({90, 30, 5}, {0, 120});
  std::vector<Radiances> up_to;
  json scene = lit_from(tall_earth(), sun_deg);
  for (int n = 1; n <= most; ++n) {
    up_to.push_back(trial.look(changed(scene, {{"method", {{"scattering_orders", n}}}}), rays));
  }
  Radiances all = trial.look(scene, rays);
  Measured gap = largest(rays.size(), [&](std::size_t i, std::size_t c) {
    check_orders(trial, up_to, i, c);
    auto light = [&](int n) { return up_to[n - 1].radiance[i][c]; };
    auto noise = [&](int n) { return noise_of(up_to[n - 1], i, c); };
    double before = light(most - 1) - light(most - 2), last = light(most) - light(most - 1);
    double ratio = before > 0 ? std::clamp(last / before, 0.0, 0.9) : 0;
    double series = light(most) + std::max(last, 0.0) * ratio / (1 - ratio);
    return apart(
        all.radiance[i][c], series,
        together({noise_of(all, i, c), noise(most), noise(most - 1), noise(most - 2)}));
  });
  for (const Radiances& part : up_to) gap.stated = std::max(gap.stated, trial.stated(part));
  gap.stated = std::max(gap.stated, trial.stated(all));
  return gap;
}

StabilityRow truncated_orders() {
  StabilityRow row{.number = 8,
                   .name = "Orders left out",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "relative difference of all orders from nine and the geometric "
                       "series of their last; no order is negative, and none from the fifth "
                       "to the ninth is brighter than the one before",
                   .bound = 0.01,
                   .many_orders = true,
                   .stated_errors = 3,
                   .sweep = {-6, -9, -12, -15, -18},
                   .hardest = -9};
  row.scene = [](double x) {
    return lit_from(changed(tall_earth(), {{"camera", {{"pitch_deg", 20}}}}), x);
  };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    return {series_gap(trial, x)};
  };
  return row;
}

StabilityRow shadow_edge() {
  StabilityRow row{.number = 9,
                   .name = "Edge of the planet's shadow",
                   .trigger = "sun's elevation, deg",
                   .quantity = "error across the edge opposite the sun",
                   .bound = 0.02,
                   .stated_errors = 1,
                   .sweep = {0, -0.5, -1, -2},
                   .hardest = -1};
  row.scene = [](double x) {
    return lit_from(changed(plain_scene(), {{"camera", {{"pitch_deg", 8}, {"fov_deg", 20}}}}),
                    x, 180);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    return measured(trial.error(scene(x), fan(spaced(0.2, 14, 24), {0})));
  };
  return row;
}

StabilityRow mirror_seam() {
  StabilityRow row{.number = 10,
                   .name = "Seam in azimuth",
                   .trigger = "sun's elevation, deg",
                   .quantity =
                       "relative difference between left and right of the sun, and from "
                       "straight ahead to 0.25 deg aside",
                   .bound = 1e-3,
                   .sweep = {60, 20, 3, -4},
                   .hardest = 3};
  row.scene = [](double x) {
    return lit_from(changed(plain_scene(), {{"camera", {{"pitch_deg", 20}, {"fov_deg", 70}}}}),
                    x, 37.3);
  };
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    constexpr double sun_deg = 37.3;
    std::vector<double> elevations;
    for (double elevation : {2.0, 10.0, 35.0, 80.0}) {
      if (std::abs(elevation - x) > 5) elevations.push_back(elevation);
    }
    std::vector<double> left{0, 180}, right{0, 180};
    for (double aside : {0.25, 20.0, 90.0, 160.0, 179.75}) {
      left.push_back(sun_deg - aside);
      right.push_back(sun_deg + aside);
    }
    left[0] = right[0] = sun_deg;
    left[1] = right[1] = sun_deg + 180;
    Radiances a = trial.look(scene(x), fan(elevations, left)),
              b = trial.look(scene(x), fan(elevations, right));
    Measured worst = 0;
    auto compare = [&](const Radiances& one, std::size_t i, const Radiances& other,
                       std::size_t j) {
      for (std::size_t c = 0; c < 3; ++c) {
        worst = larger(worst, apart(one.radiance[i][c], other.radiance[j][c],
                                    together({noise_of(one, i, c), noise_of(other, j, c)})));
      }
    };
    for (std::size_t e = 0; e < elevations.size(); ++e) {
      std::size_t at = e * left.size();
      for (std::size_t k = 2; k < left.size(); ++k) compare(a, at + k, b, at + k);
      compare(a, at, b, at + 2);                    // towards the sun
      compare(a, at + 1, b, at + left.size() - 1);  // away from it
    }
    return {worst};
  };
  return row;
}

json large_sun(double diameter_deg, int samples) {
  return changed(lit_from(plain_scene(), 25), {{"sun",
                                                {{"angular_diameter_deg", diameter_deg},
                                                 {"limb_darkening", false},
                                                 {"disc_samples", samples}}}});
}

struct DiscPoint {
  double elevation_deg, azimuth_deg, weight;
};

/// Equal solid angles in three rings of Gauss-Legendre radii, eight points each. Together they
/// light a plane that faces the disc's centre as one sun does.
std::vector<DiscPoint> disc_points(double elevation_deg, double diameter_deg) {
  constexpr std::array<double, 3> node{0.1127016653792583, 0.5, 0.8872983346207417},
      weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  double edge = 1 - std::cos(diameter_deg / 2 * degree), e = elevation_deg * degree,
         facing = 1 - edge / 2;  // mean of the cosine
  std::vector<DiscPoint> points;
  for (int ring = 0; ring < 3; ++ring) {
    double radius = std::acos(1 - edge * node[ring]);  // areas of caps go with 1 - cos
    for (int k = 0; k < 8; ++k) {
      double turn = (k + 0.5 * (ring % 2)) * std::numbers::pi / 4;
      double up = std::sin(radius) * std::cos(turn), aside = std::sin(radius) * std::sin(turn),
             along = std::cos(radius);
      double z = along * std::sin(e) + up * std::cos(e),
             y = along * std::cos(e) - up * std::sin(e);
      points.push_back(
          {std::asin(z) / degree, std::atan2(aside, y) / degree, weight[ring] / 8 / facing});
    }
  }
  return points;
}

StabilityRow large_suns() {
  StabilityRow row{.number = 17,
                   .name = "Large suns",
                   .trigger = "angular diameter, deg",
                   .quantity =
                       "relative difference of 64 disc samples from the mean of 24 suns "
                       "that are points",
                   .bound = 0.02,
                   .sweep = {1, 10, 40},
                   .hardest = 40};
  row.scene = [](double x) { return large_sun(x, 64); };
  row.measure = [](Trial& trial, double x) -> std::vector<Measured> {
    auto rays = fan({80, 40, 8}, {90, 180});
    Radiances whole = trial.look(large_sun(x, 64), rays);
    Samples mean(rays.size(), std::vector<double>(3, 0.0)), noise = mean;
    for (const DiscPoint& point : disc_points(25, x)) {
      json scene = lit_from(plain_scene(), point.elevation_deg, point.azimuth_deg);
      Radiances part = trial.look(scene, rays, whole.plan);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          mean[i][c] += point.weight * part.radiance[i][c];
          noise[i][c] = together({noise[i][c], point.weight * noise_of(part, i, c)});
        }
      }
    }
    return {largest(rays.size(), [&](std::size_t i, std::size_t c) {
      return apart(whole.radiance[i][c], mean[i][c],
                   together({noise_of(whole, i, c), noise[i][c]}));
    })};
  };
  return row;
}

}  // namespace

std::vector<StabilityRow> rows_of_suns() {
  return {late_twilight(), truncated_orders(), shadow_edge(), mirror_seam(), large_suns()};
}

}  // namespace cyanometer
