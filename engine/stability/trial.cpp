#include "engine/stability/trial.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/finest.h"
#include "engine/accuracy/reference.h"
#include "engine/problem.h"
#include "engine/scene/document.h"
#include "engine/stability/brightest.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;

const MethodDescription* described(const std::string& name) {
  for (const MethodDescription& method : methods()) {
    if (method.name == name) return &method;
  }
  return nullptr;  // auto
}

/// About as many as an irradiance is summed from, whose noise they share.
constexpr std::size_t hemisphere_rays = 16384;

[[noreturn]] void broken(const char* what, double value, const Direction& at) {
  char text[128];
  std::snprintf(text, sizeof text, "%s %g at elevation %g, azimuth %g", what, value,
                at.elevation_deg, at.azimuth_deg);
  throw BrokenFrame(text);
}

/// Walks may make more of the light than there is by their noise, and quadrature by its error.
void check(const Radiances& radiances, const std::vector<Direction>& directions,
           const std::vector<double>& brightest) {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const std::vector<double>& values = radiances.radiance[i];
    for (std::size_t w = 0; w < values.size(); ++w) {
      if (!(values[w] >= 0 && std::isfinite(values[w])))
        broken("radiance", values[w], directions[i]);
      double sure = values[w];
      if (radiances.standard_error) sure -= 4 * (*radiances.standard_error)[i][w];
      if (sure > 2 * brightest[w])
        broken("radiance beyond what the sun sends in,", values[w], directions[i]);
    }
    for (double value : radiances.transmittance[i]) {
      if (!(value >= 0 && value <= 1 + 1e-6)) broken("transmittance", value, directions[i]);
    }
  }
}

template <class Take>
Samples traced(const Scene& scene, const std::vector<Direction>& directions, const Take& take) {
  const std::vector<double> wavelengths_nm = wavelengths_of(scene);
  oracle::Adaptive adaptive(pack<double>(make_problem(scene, wavelengths_nm)), 1e-6);
  Samples values;
  for (const Direction& d : directions) {
    double e = glm::radians(d.elevation_deg), a = glm::radians(d.azimuth_deg);
    std::vector<double> ray = take(
        adaptive.trace({std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)}));
    ray.resize(wavelengths_nm.size());
    values.push_back(std::move(ray));
  }
  return values;
}

Samples channel(const Samples& values, std::size_t c) {
  Samples one;
  for (const auto& ray : values) one.push_back({ray[c]});
  return one;
}

/// Of each ray the channels' shares of their sum.
Samples hues(Samples values) {
  for (auto& ray : values) {
    const double sum = std::accumulate(ray.begin(), ray.end(), 0.0);
    for (double& value : ray) value = sum > 0 ? value / sum : 0;
  }
  return values;
}

}  // namespace

std::vector<double> wavelengths_of(const Scene& scene) {
  const auto& named = scene.spectrum.wavelengths_nm;
  return named.empty() ? std::vector<double>{680, 550, 440} : named;
}

std::vector<Direction> fan(const std::vector<double>& elevations_deg,
                           const std::vector<double>& azimuths_deg) {
  std::vector<Direction> directions;
  for (double elevation : elevations_deg) {
    for (double azimuth : azimuths_deg) directions.push_back({elevation, azimuth});
  }
  return directions;
}

std::vector<double> spaced(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first + (last - first) * i / (count - 1));
  return values;
}

Trial::Trial(Engine& engine, std::string method, std::filesystem::path references,
             double most_work, const Watch& watch)
    : engine_(engine),
      method_(std::move(method)),
      references_(std::move(references)),
      most_work_(most_work),
      watch_(watch) {}

bool Trial::first_order_only() const {
  const MethodDescription* method = described(method_);
  return method && method->highest_order == 1;
}

Scene Trial::scene_of(json document) const {
  document["method"]["name"] = method_;
  if (first_order_only()) document["method"]["scattering_orders"] = 1;
  return read_scene(document);
}

Plan Trial::plan_of(const Scene& scene, std::size_t directions) const {
  Plan plan;
  plan.method = method_;
  plan.options = scene.method.options;
  plan.wavelengths_nm = wavelengths_of(scene);
  if (described(method_)->random) {
    // Enough walks that noise does not hide what is measured.
    double walks = most_work_ / static_cast<double>(directions);
    plan.options["samples_per_pixel"] =
        std::clamp(std::exp2(std::floor(std::log2(walks))), 8.0, 16384.0);
  }
  return plan;
}

Radiances Trial::look(const json& document, const std::vector<Direction>& directions,
                      bool irradiance) {
  watch_.check();
  Scene scene = scene_of(document);
  Radiances radiances;
  if (method_ == "auto") {
    radiances = engine_.radiance(scene, directions, irradiance, watch_);
  } else {
    radiances = engine_.radiance(
        scene, directions, irradiance,
        plan_of(scene, irradiance ? hemisphere_rays : directions.size()), watch_);
  }
  check(radiances, directions, brightest_possible(scene, radiances.wavelengths_nm));
  return radiances;
}

Radiances Trial::look(const json& document, const std::vector<Direction>& directions,
                      const Plan& plan) {
  watch_.check();
  Scene scene = scene_of(document);
  Radiances radiances = engine_.radiance(scene, directions, false, plan, watch_);
  check(radiances, directions, brightest_possible(scene, radiances.wavelengths_nm));
  return radiances;
}

void Trial::picture(const json& document, int width, const Plan& plan) {
  watch_.check();
  json small = document;
  small["image"]["width"] = width;
  if (scene_of(small).camera.projection == Projection::perspective)
    small["image"]["height"] = width * 9 / 16;
  const Scene scene = scene_of(small);
  Frame frame = engine_.render(scene, plan, watch_);
  const int pixels = frame.width * frame.height;
  for (const Frame::Plane& plane : frame.planes) {
    for (int i = 0; i < pixels; ++i) {
      if (!std::isfinite(plane.samples[i]))
        throw BrokenFrame("pixel " + std::to_string(i) + " of " + plane.channel + " is " +
                          std::to_string(plane.samples[i]));
    }
  }
}

Samples Trial::first_order(const json& document, const std::vector<Direction>& directions) {
  return traced(read_scene(document), directions, [](oracle::Ray ray) {
    for (std::size_t w = 0; w < ray.ground.size(); ++w) ray.inscatter[w] += ray.ground[w];
    return ray.inscatter;
  });
}

Samples Trial::transmittance(const json& document, const std::vector<Direction>& directions) {
  return traced(read_scene(document), directions,
                [](const oracle::Ray& ray) { return ray.transmittance; });
}

Samples Trial::smooth_truth(const json& document, const std::vector<Direction>& directions) {
  if (first_order_only()) return first_order(document, directions);
  Scene scene = read_scene(document);
  Plan plan = finest_plan(scene, scene.spectrum.wavelengths_nm);
  return engine_.radiance(scene, directions, false, plan, watch_).radiance;
}

std::optional<Trial::Halves> Trial::compared(const json& document,
                                             const std::vector<Direction>& directions) {
  Scene scene = scene_of(document);
  Halves halves;
  if (scene.method.scattering_orders == 1) {
    halves.a = halves.b = first_order(document, directions);
  } else {
    if (is_reference()) return {};
    ReferenceGoal goal{.rays = 0, .noise = 0.004, .most_walks = 0};
    goal.most_walks = static_cast<std::int64_t>(
        std::clamp(most_work_ / static_cast<double>(directions.size()), 512.0, 262144.0));
    Reference reference = make_reference(engine_, scene, directions, goal, references_, watch_);
    halves.a = std::move(reference.halves[0]);
    halves.b = std::move(reference.halves[1]);
  }
  Radiances seen = look(document, directions);
  halves.stated = stated(seen);
  halves.values = std::move(seen.relative);
  return halves;
}

std::optional<Measured> Trial::error(const json& scene,
                                     const std::vector<Direction>& directions) {
  std::optional<Halves> found = compared(scene, directions);
  if (!found) return {};
  Measured error = measure_error(found->values, found->a, found->b);
  error.stated = found->stated;
  return error;
}

std::optional<Measured> Trial::error_by_channel(const json& scene,
                                                const std::vector<Direction>& directions) {
  std::optional<Halves> found = compared(scene, directions);
  if (!found) return {};
  Measured worst = 0;
  for (std::size_t c = 0; c < found->values.front().size(); ++c) {
    Measured error =
        measure_error(channel(found->values, c), channel(found->a, c), channel(found->b, c));
    if (error.value >= worst.value) worst = error;
  }
  worst.stated = found->stated;
  return worst;
}

std::optional<Measured> Trial::error_of_hue(const json& scene,
                                            const std::vector<Direction>& directions) {
  std::optional<Halves> found = compared(scene, directions);
  if (!found) return {};
  Measured error = measure_error(hues(found->values), hues(found->a), hues(found->b));
  error.stated = found->stated;
  return error;
}

double Trial::stated(const Radiances& seen) const {
  return method_ == "auto" ? seen.plan.expected_error : 0;
}

}  // namespace cyanometer
