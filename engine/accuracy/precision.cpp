#include "engine/accuracy/precision.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/accuracy/chart.h"
#include "engine/accuracy/error.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using Samples = std::vector<std::vector<double>>;
constexpr int precision_rays = 256;

Engine engine_with(Rounding rounding, const std::string& device) {
  return Engine({.device = device,
                 .kernels = EngineOptions::kernels_for_many_scenes,
                 .rounding = rounding});
}

const MethodDescription& described(const std::string& name) {
  for (const MethodDescription& method : methods()) {
    if (method.name == name) return method;
  }
  throw std::invalid_argument("no method is called " + name);
}

Plan plan_of(const Scene& scene, const MethodDescription& method) {
  Plan plan;
  plan.method = method.name;
  plan.options = defaults_of(method);
  plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
  return plan;
}

/// Walks that take another turn are as good: what is left of them is their mean. The channels
/// of a ray share its walks.
PrecisionPoint of_walks(const Samples& values, const Samples& nearest) {
  const std::vector<double> d = relative_differences(values, nearest);
  const std::size_t channels = nearest.front().size();
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < d.size(); i += channels) {
    double ray = 0;
    for (std::size_t c = 0; c < channels; ++c) ray += d[i + c] / static_cast<double>(channels);
    sum += ray;
    squares += ray * ray;
  }
  const double count = static_cast<double>(nearest.size()), mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

std::string figure(const PrecisionPoint& point) {
  char text[64];
  if (point.noise > 0) {
    std::snprintf(text, sizeof text, "%.0e ± %.0e", point.error, point.noise);
  } else {
    std::snprintf(text, sizeof text, "%.0e", point.error);
  }
  return point.error == 0 ? "0" : text;
}

}  // namespace

PrecisionTrial::PrecisionTrial(const std::string& device)
    : engines_{engine_with(Rounding::nearest, device), engine_with(Rounding::up, device),
               engine_with(Rounding::down, device),
               engine_with(Rounding::towards_zero, device)} {
  Scene scene = read_scene({{"spectrum", {{"wavelengths_nm", {550}}}}});
  const std::vector<Direction> zenith{{90, 0}};
  const Plan plan = plan_of(scene, described("nishita"));
  const auto value = [&](std::size_t i) {
    return engines_[i].radiance(scene, zenith, false, plan).radiance[0][0];
  };
  if (value(1) == value(2)) {
    throw std::runtime_error("the rounding of " + this->device().name +
                             " can't be turned; that of lavapipe can");
  }
}

PrecisionPoint PrecisionTrial::measure(const Scene& scene, const std::string& name,
                                       const Watch& watch) {
  return measure(scene, plan_of(scene, described(name)), watch);
}

PrecisionPoint PrecisionTrial::measure(const Scene& scene, const Plan& plan,
                                       const Watch& watch) {
  const std::vector<Direction> directions = sample_directions(scene, precision_rays);
  std::array<Samples, 4> values;
  for (std::size_t i = 0; i < engines_.size(); ++i)
    values[i] = engines_[i].radiance(scene, directions, false, plan, watch).radiance;
  PrecisionPoint worst;
  for (std::size_t i = 1; i < engines_.size(); ++i) {
    PrecisionPoint point = described(plan.method).random
                               ? of_walks(values[i], values[0])
                               : PrecisionPoint{measure_error(values[i], values[0]).error, 0};
    if (std::abs(point.error) > std::abs(worst.error)) worst = point;
  }
  return worst;
}

std::string precision_table_head() {
  std::string head = "| preset |", rule = "|---|";
  for (const MethodDescription& method : methods()) {
    head += " `" + method.name + "` |";
    rule += "---|";
  }
  return head + "\n" + rule + "\n";
}

std::string precision_table_line(const std::string& name,
                                 const std::vector<PrecisionPoint>& by_method) {
  std::string line = "| " + name + " |";
  for (const PrecisionPoint& point : by_method) line += " " + figure(point) + " |";
  return line + "\n";
}

}  // namespace cyanometer
