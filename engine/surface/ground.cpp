#include "engine/surface/ground.h"

#include "engine/optics/spectrum.h"
#include "engine/surface/pack_ground.h"
#include "engine/surface/upsampling.h"
#include "engine/surface/world.h"

namespace cyanometer {
namespace {

using P = physics::Physics<double>;

/// Ground of a map, but for its images.
Ground coloured(const std::array<double, 3>& mean_rgb,
                const std::vector<double>& wavelengths_nm) {
  Ground ground;
  ground.kind = P::SURFACE_MAP;
  ground.slope_variance = 1;  // idle: no sea mirrors
  ground.sea_reflectance.assign(P::SEA_NODES, 0.0);
  ground.mean_share.assign(P::MATTERS, 0.0);
  ground.albedo.assign(P::MATTERS, std::vector<double>(wavelengths_nm.size(), 0.0));
  for (int c = 0; c < 3; ++c) {
    ground.mean_share[P::RED + c] = mean_rgb[c];
    for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
      ground.albedo[P::RED + c][w] = reflectance_basis(wavelengths_nm[w])[c];
    }
  }
  return ground;
}

struct Making {
  const Scene& scene;
  const std::vector<double>& wavelengths_nm;

  std::optional<Ground> operator()(const UniformSurface&) const { return std::nullopt; }

  std::optional<Ground> operator()(const ProceduralSurface& surface) const {
    World world = world_of(surface);
    Ground ground;
    ground.kind = P::SURFACE_PROCEDURAL;
    ground.relief_km = surface.relief_km;
    ground.sea_level = world.sea_level;
    ground.gain = terrain_gain(surface);
    ground.slope_variance = sea_slope_variance(surface);
    ground.ice_latitude_deg = surface.ice_latitude_deg;
    ground.vegetation = surface.vegetation;
    ground.seed = surface.seed;
    SeaReflectance sea = sea_reflectance(ground.slope_variance);
    ground.mean_sea_reflectance = sea.mean;
    ground.sea_reflectance.assign(sea.by_cosine.begin(), sea.by_cosine.end());
    ground.mean_share.assign(world.mean_share.begin(), world.mean_share.end());
    // In the order of shaders/surface/data.glsl.
    for (const Spectrum* spectrum :
         {&surface.sea, &surface.plants, &surface.sand, &surface.rock, &surface.ice}) {
      ground.albedo.push_back(
          evaluate(*spectrum, scene.spectrum.wavelengths_nm, wavelengths_nm));
    }
    ground.latitude_deg = scene.camera.latitude_deg;
    ground.longitude_deg = scene.camera.longitude_deg;
    return ground;
  }

  std::optional<Ground> operator()(const MapSurface& surface) const {
    auto images = surface_images(surface);
    Ground ground = coloured(images->mean_rgb, wavelengths_nm);
    ground.images = std::move(images);
    ground.relief_km = surface.height.empty() ? 0 : surface.height_km;
    ground.latitude_deg = scene.camera.latitude_deg;
    ground.longitude_deg = scene.camera.longitude_deg;
    return ground;
  }
};

}  // namespace

std::optional<Ground> make_ground(const Scene& scene,
                                  const std::vector<double>& wavelengths_nm) {
  return std::visit(Making{scene, wavelengths_nm}, scene.planet.surface);
}

std::vector<double> mean_albedo(const Ground& ground) {
  std::vector<double> mean(ground.albedo.front().size(), 0.0);
  double mirrored = ground.mean_sea_reflectance;
  for (std::size_t m = 0; m < ground.albedo.size(); ++m) {
    for (std::size_t w = 0; w < mean.size(); ++w) {
      double albedo = ground.albedo[m][w];
      if (m == P::SEA) albedo = mirrored + (1 - mirrored) * albedo;
      mean[w] += ground.mean_share[m] * albedo;
    }
  }
  return mean;
}

std::optional<std::vector<double>> mean_albedo(const Scene& scene,
                                               const std::vector<double>& wavelengths_nm) {
  if (const auto* map = std::get_if<MapSurface>(&scene.planet.surface)) {
    return mean_albedo(coloured(surface_mean_rgb(*map), wavelengths_nm));
  }
  auto ground = make_ground(scene, wavelengths_nm);
  return ground ? std::optional(mean_albedo(*ground)) : std::nullopt;
}

double height_at_foot_km(const Ground& ground, double planet_radius_km) {
  P p;
  p.scene.planet_radius_km = planet_radius_km;
  p.SURFACE_KIND = ground.kind;
  p.surface_values = packed_ground<double>(ground);
  if (ground.images) p.surface_texels = ground.images->texels;
  return p.surface_height_km({0, 0, planet_radius_km}, 0);
}

}  // namespace cyanometer
