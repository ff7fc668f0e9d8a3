// Radiances along given directions, and irradiances.
#include <algorithm>
#include <cmath>

#include "engine/irradiance.h"
#include "engine/optics/colour.h"
#include "engine/parts.h"

namespace cyanometer {
namespace {

glm::dvec3 unit_vector(const Direction& d) {
  double elevation = glm::radians(d.elevation_deg), azimuth = glm::radians(d.azimuth_deg);
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

/// Of one point of the sun's disc: where it stands, and the irradiance that it gives a
/// horizontal plane at the camera, per unit of the sun's and by wavelength, through no air.
struct LitPoint {
  glm::dvec3 direction;
  std::vector<double> irradiance;
};

/// The points of the disc that neither the ground nor its heights hide from the camera.
std::vector<LitPoint> lit_points(Physics<double>& physics, std::size_t wavelengths) {
  double altitude_km = physics.scene.camera_altitude_km;
  glm::dvec3 camera(0, 0, physics.scene.planet_radius_km + altitude_km);
  double visible = 1;
  if (physics.SURFACE_KIND != Physics<double>::SURFACE_UNIFORM) {
    constexpr double detail = 1e-4;  // of the planet's radius, as raymarch.comp
    visible = physics.sun_over_heights(camera, altitude_km,
                                       physics.sun_ray(camera, glm::dvec3(0)).direction,
                                       detail * physics.scene.planet_radius_km);
  }
  std::vector<LitPoint> points;
  for (int k = 0; k < physics.scene.disc_points; ++k) {
    auto sun = physics.sun_ray(camera, physics.sun_offset(k));
    if (!(sun.direction.z > 0) || physics.path_from_camera(sun.direction).meets_ground)
      continue;
    LitPoint& point = points.emplace_back(LitPoint{sun.direction, {}});
    for (std::size_t w = 0; w < wavelengths; ++w) {
      double weight = physics.sun_weight(k, static_cast<int>(w / 4))[static_cast<int>(w % 4)];
      point.irradiance.push_back(visible * weight * sun.irradiance * sun.direction.z);
    }
  }
  return points;
}

std::vector<double> weighted_sum(const Samples& radiance, const std::vector<double>& weights,
                                 std::size_t wavelengths) {
  std::vector<double> sum(wavelengths, 0.0);
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    for (std::size_t w = 0; w < wavelengths; ++w) sum[w] += weights[i] * radiance[i][w];
  }
  return sum;
}

void scale_by(const std::vector<double>& irradiance, Samples& radiance) {
  for (auto& ray : radiance) {
    for (std::size_t w = 0; w < ray.size(); ++w) ray[w] *= irradiance[w];
  }
}

std::vector<glm::dvec3> unit_vectors(const std::vector<Direction>& directions) {
  std::vector<glm::dvec3> vectors;
  for (const Direction& d : directions) vectors.push_back(unit_vector(d));
  return vectors;
}

/// As many as a plan looks at.
std::vector<glm::dvec3> evenly_from(const std::vector<glm::dvec3>& rays) {
  std::size_t count = std::min<std::size_t>(plan_probes, rays.size());
  std::vector<glm::dvec3> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(rays[i * rays.size() / count]);
  return some;
}

}  // namespace

Radiances Engine::radiance(const Scene& scene, const std::vector<Direction>& directions,
                           bool irradiance, const Watch& watch) {
  auto start = Parts::Clock::now();
  // Errors of radiances are always by wavelength.
  Scene spectral = scene;
  spectral.spectrum.colour = Colour::channels;
  if (scene.spectrum.wavelengths_nm.empty()) {
    spectral.spectrum.wavelengths_nm = colour_wavelengths(16);
  }
  std::vector<glm::dvec3> rays = unit_vectors(directions);
  Plan plan =
      parts_->plan(spectral, {evenly_from(rays)}, {static_cast<double>(rays.size())}, watch);
  double planning_ms = ms_since(start);
  Radiances result = radiance(scene, directions, irradiance, plan, watch);
  result.prepare_ms += planning_ms;
  return result;
}

Radiances Engine::radiance(const Scene& scene, const std::vector<Direction>& directions,
                           bool irradiance, const Plan& plan, const Watch& watch) {
  auto start = Parts::Clock::now();
  std::vector<glm::dvec3> rays = unit_vectors(directions);
  Radiances result;
  result.plan = plan;
  result.wavelengths_nm = plan.wavelengths_nm;
  Problem problem = make_problem(scene, result.wavelengths_nm);
  std::vector<double> sunlight = make_output(scene, result.wavelengths_nm).irradiance;
  result.prepare_ms = ms_since(start);
  auto rendering = Parts::Clock::now();
  double tables_before = parts_->tables.making_ms();
  auto trace = [&](const std::vector<glm::dvec3>& towards) {
    return parts_->trace_rays(problem, {towards}, result.plan.method, result.plan.options,
                              watch);
  };
  Parts::Traced traced = trace(rays);
  result.radiance = result.relative = std::move(traced.radiance);
  result.transmittance = std::move(traced.transmittance);
  scale_by(sunlight, result.radiance);
  if (!traced.standard_error.empty()) {
    scale_by(sunlight, traced.standard_error);
    result.standard_error = std::move(traced.standard_error);
  }
  if (irradiance) {
    Physics<double> physics = pack<double>(problem);
    auto direct_irradiance = [&] {
      std::vector<LitPoint> points = lit_points(physics, sunlight.size());
      std::vector<glm::dvec3> towards;
      for (const LitPoint& point : points) towards.push_back(point.direction);
      std::vector<double> sum(sunlight.size(), 0.0);
      if (points.empty()) return sum;
      Samples transmittance = trace(towards).transmittance;
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t w = 0; w < sum.size(); ++w)
          sum[w] += points[i].irradiance[w] * transmittance[i][w];
      }
      return sum;
    };
    HemisphereRule sky = hemisphere_rule(problem, true),
                   below = hemisphere_rule(problem, false);
    std::size_t count = sunlight.size();
    Samples fluxes{direct_irradiance(),
                   weighted_sum(trace(sky.directions).radiance, sky.weights, count),
                   weighted_sum(trace(below.directions).radiance, below.weights, count)};
    scale_by(sunlight, fluxes);
    result.irradiance = {fluxes[0], fluxes[1], fluxes[2]};
  }
  double tables_ms = parts_->tables.making_ms() - tables_before;
  result.prepare_ms += tables_ms;
  result.render_ms = ms_since(rendering) - tables_ms;
  return result;
}

}  // namespace cyanometer
