// Plans of frames: on which rays they are made, for which frames one holds, and the profile of
// the device that they reckon with.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/parts.h"
#include "engine/planner/nearby.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

template <class T>
void append_bytes(std::string& key, const std::vector<T>& values) {
  auto bytes = std::as_bytes(std::span(values));
  key.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Rays probes_of(const Scene& scene, const Picture* picture) {
  Physics<double> camera = pack<double>(make_problem(scene, some_wavelengths_of(scene)));
  return stratified_rays(camera, plan_probes, picture);
}

/// Radiance of the channels in which errors are measured: X, Y, Z or the wavelengths
/// themselves.
Samples in_error_channels(const Samples& radiance, const Scene& scene, const Output& output) {
  if (scene.spectrum.colour != Colour::cie) return radiance;
  Samples result;
  for (const std::vector<double>& ray : radiance) {
    std::vector<double>& xyz = result.emplace_back(3, 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t w = 0; w < ray.size(); ++w) xyz[c] += output.xyz[c][w] * ray[w];
    }
  }
  return result;
}

/// What stands at the ends of rays, as the air before it leaves it, in the channels in which
/// errors are measured.
Samples picture_light(const Scene& scene, const Rays& rays) {
  std::vector<double> wavelengths = wavelengths_of_transmittance(scene);
  Output output = make_output(scene, wavelengths);
  auto rows = transmittance_rows(scene, wavelengths);
  Physics<double> p = pack<double>(make_problem(scene, wavelengths));
  set_directions(p, rays.directions);
  p.ends_km.assign(rays.ends_km.begin(), rays.ends_km.end());
  p.scene.ends = static_cast<int>(p.ends_km.size());
  Samples light;
  for (std::size_t i = 0; i < rays.directions.size(); ++i) {
    int ray = static_cast<int>(i);
    auto path = p.path_of_ray(ray, p.pixel_ray(ray));
    double column[Physics<double>::MEDIA_SIZE];
    p.columns_along(path.altitude_km, path.mu, path.length_km, column);
    Triple seen{};
    for (std::size_t w = 0; !path.meets_ground && w < wavelengths.size(); ++w) {
      int group = static_cast<int>(w / 4), lane = static_cast<int>(w % 4);
      double transmittance = p.transmittance_of(column, group)[lane];
      for (std::size_t c = 0; c < 3; ++c) {
        seen[c] += rows[c][w] * transmittance * rays.colours[i][c];
      }
    }
    bool cie = scene.spectrum.colour == Colour::cie;
    if (cie) seen = xyz_from_rec709() * seen;
    for (std::size_t c = 0; !cie && c < 3; ++c) seen[c] /= output.irradiance[c];
    light.emplace_back(seen.begin(), seen.end());
  }
  return light;
}

}  // namespace

Plan Engine::Parts::plan(const Scene& scene, const Rays& probes, Extent extent,
                         const Watch& watch) {
  bool parts = !probes.ends_km.empty();
  Samples light = parts ? picture_light(scene, probes) : Samples{};
  TraceProbe probe = [&](const std::string& name, const MethodOptions& options,
                         const std::vector<double>& wavelengths) {
    Problem problem = make_problem(scene, wavelengths);
    Watch quiet = watch;
    quiet.progress = [](double) {};
    Traced traced = trace_rays(problem, probes, name, options, quiet);
    Samples seen = in_error_channels(traced.radiance, scene, make_output(scene, wavelengths));
    for (std::size_t i = 0; i < light.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) seen[i][c] += light[i][c];
    }
    return seen;
  };
  return make_plan({scene, extent, methods, profile, probe,
                    parts || has_heights(make_problem(scene, some_wavelengths_of(scene)))});
}

Plan Engine::Parts::plan_frame(const Scene& scene, const Watch& watch) {
  if (scene.method.verify) return plan_this_frame(scene, watch);
  Scene alike = nearby(scene);
  return known_plan(canonical(alike).dump() + ground_revision(alike),
                    [&] { return plan_this_frame(alike, watch); });
}

Plan Engine::Parts::plan_composite(const Scene& scene, const Picture& picture,
                                   const Watch& watch) {
  Rays rays = probes_of(scene, &picture);
  std::string key = canonical(scene).dump() + ground_revision(scene);
  append_bytes(key, rays.ends_km);
  append_bytes(key, rays.colours);
  return known_plan(key, [&] {
    Extent extent = extent_of(scene, watch);
    extent.sparse_rays = 0;
    return plan(scene, rays, extent, watch);
  });
}

Plan Engine::Parts::known_plan(const std::string& key, const std::function<Plan()>& make) {
  constexpr std::size_t most_plans = 4096, longest_key = 1 << 14;
  if (auto known = plans.find(key); known != plans.end()) return known->second;
  if (plans.size() >= most_plans) plans.clear();
  Plan plan = make();
  if (key.size() > longest_key) return plan;  // spectra of thousands of numbers fill a memory
  return plans[key] = std::move(plan);
}

Extent Engine::Parts::extent_of(const Scene& scene, const Watch& watch) {
  constexpr int side = 48;
  Physics<double> camera = pack<double>(make_problem(scene, some_wavelengths_of(scene)));
  const int columns = std::min(side, scene.image.width),
            rows = std::min(side, scene.image.height);
  const auto met = static_cast<double>(pixels_of_grid(camera, columns, rows).size());
  const double pixels = static_cast<double>(scene.image.width) * scene.image.height;
  return {pixels * met / (columns * rows), pixels, sparse_rays_of(scene, watch)};
}

Plan Engine::Parts::plan_this_frame(const Scene& scene, const Watch& watch) {
  return plan(scene, probes_of(scene, nullptr), extent_of(scene, watch), watch);
}

Plan Engine::plan(const Scene& scene, const Watch& watch) {
  return parts_->plan_frame(scene, watch);
}

double Engine::expected_ms(const Scene& scene, const Plan& plan) {
  return cyanometer::expected_ms(parts_->profile, parts_->method(plan.method), plan.options,
                                 make_problem(scene, some_wavelengths_of(scene)),
                                 parts_->extent_of(scene, {}), plan.wavelengths_nm.size());
}

Plan Engine::plan(const Scene& scene, const Picture& picture, const Watch& watch) {
  return parts_->plan_composite(scene, picture, watch);
}

double Engine::frame_ms(const Scene& scene, const Plan& plan, const Watch& watch) {
  forget_tables();
  const double before = tables().making_ms;
  const double ms = render(scene, plan, watch).render_ms;
  return ms + tables().making_ms - before;
}

namespace {

/// The median of some times of a frame without others in between, once it is compiled; of one
/// that is long, its one.
double median_ms(Engine& engine, const Scene& scene, const Plan& plan, const Watch& watch) {
  constexpr std::size_t repeats = 3;
  constexpr double long_ms = 500;
  engine.frame_ms(scene, plan, watch);
  std::vector<double> times;
  do {
    watch.check();
    times.push_back(engine.frame_ms(scene, plan));
  } while (times.size() < repeats && times.front() < long_ms);
  std::ranges::sort(times);
  return times[times.size() / 2];
}

/// A scene of which every pixel shows the air, or none does.
Scene profiled_scene(bool air) {
  return read_scene({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                     {"camera", {{"altitude_km", air ? 0.002 : 1e5}, {"pitch_deg", 45}}},
                     {"image", {{"width", 320}, {"height", 180}}}});
}

}  // namespace

std::map<std::string, double> Engine::measure_profile(const Watch& watch) {
  Plan plan;
  plan.wavelengths_nm = {680, 550, 440};
  plan.method = "raymarch";
  for (const MethodDescription& method : methods()) {
    if (method.name == plan.method) plan.options = method.ladder.front();
  }
  plan.options["interpolation"] = 0;
  const double frame_ms = median_ms(*this, profiled_scene(false), plan, watch);
  const Scene scene = profiled_scene(true);
  const Extent extent = parts_->extent_of(scene, watch);
  DeviceProfile profile;
  profile.evaluations_per_ms[DeviceProfile::frame] =
      extent.pixels * DeviceProfile::evaluations_per_pixel / frame_ms;
  for (const MethodDescription& method : methods()) {
    if (method.ladder.empty()) continue;
    plan.method = method.name;
    plan.options = method.ladder.front();
    if (!method.random) plan.options["interpolation"] = 0;
    const double method_ms = median_ms(*this, scene, plan, watch) - frame_ms,
                 expected =
                     cyanometer::expected_ms({}, parts_->method(method.name), plan.options,
                                             make_problem(scene, plan.wavelengths_nm),
                                             {extent.rays}, plan.wavelengths_nm.size());
    profile.evaluations_per_ms[method.name] =
        expected * DeviceProfile::nominal / std::max(method_ms, 0.1 * frame_ms);
  }
  parts_->profile = profile;
  parts_->plans.clear();
  // Where nothing can be written it holds until the end of the process.
  save_profile(parts_->profiles, parts_->identity, profile);
  return profile.evaluations_per_ms;
}

}  // namespace cyanometer
