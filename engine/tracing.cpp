// Rays by a method: the scene's wavelengths in batches, the rays in tiles.
#include <algorithm>

#include "engine/parts.h"

namespace cyanometer {
namespace {

void end_at(std::span<const float> ground_km, Rays& rays) {
  if (rays.ends_km.empty()) {
    rays.ends_km.assign(ground_km.begin(), ground_km.end());
    return;
  }
  for (std::size_t i = 0; i < ground_km.size(); ++i) {
    rays.ends_km[i] = std::min(rays.ends_km[i], ground_km[i]);
  }
}

}  // namespace

auto Engine::Parts::upload(const Problem& problem, const Rays& rays, std::size_t most,
                           GroundBuffers ground) -> std::vector<Batch> {
  auto ends =
      rays.ends_km.empty() ? nullptr : std::make_shared<const RayEnds>(device, rays.ends_km);
  std::vector<Batch> batches;
  std::size_t count = problem.wavelengths_nm.size();
  for (std::size_t first = 0; first < count; first += most) {
    Problem part = at_wavelengths(problem, first, std::min(most, count - first));
    batches.push_back({first, UploadedScene(device, part, rays.directions, ends, ground)});
  }
  return batches;
}

GroundBuffers Engine::Parts::ground_before(const Problem& problem, const Rays& rays,
                                           const Watch& watch) {
  Tracer tracer = this->tracer("surface", watch);
  int count = rays.directions.empty() ? problem.width * problem.height
                                      : static_cast<int>(rays.directions.size());
  GroundBuffers ground{surface.texels(tracer, *problem.ground), nullptr};
  UploadedScene scene(device, at_wavelengths(problem, 0, 1), rays.directions, nullptr, ground);
  ground.distances_km =
      std::make_shared<const vulkan::Buffer>(surface.distances(tracer, scene, count));
  return ground;
}

Picture Engine::Parts::before_heights(const Problem& problem, Picture picture,
                                      const Watch& watch) {
  if (!has_heights(problem)) return picture;
  GroundBuffers ground = ground_before(problem, {}, watch);
  auto ground_km = ground.distances_km->as<const float>();
  for (std::size_t i = 0; i < ground_km.size(); ++i) {
    if (ground_km[i] >= picture.distance_km[i]) continue;
    picture.distance_km[i] = ground_km[i];
    for (std::vector<float>& plane : picture.rgb) plane[i] = 0;
  }
  return picture;
}

SurfacePass::Left Engine::Parts::left_by(const Method& method, const Problem& problem) {
  if (method.reflects()) return SurfacePass::Left::walks;
  int orders = problem.scattering_orders;
  bool one = orders == 0 || orders == 1 || method.description().highest_order == 1;
  return one ? SurfacePass::Left::order_one : SurfacePass::Left::tables;
}

auto Engine::Parts::upload_with_ground(const Problem& problem, Rays rays,
                                       const std::string& name, const Watch& watch)
    -> std::vector<Batch> {
  if (!problem.ground) return upload(problem, rays);
  GroundBuffers ground = ground_before(problem, rays, watch);
  if (has_heights(problem)) end_at(ground.distances_km->as<const float>(), rays);
  std::vector<Batch> batches = upload(problem, rays, wavelengths_at_once, ground);
  if (left_by(method(name), problem) != SurfacePass::Left::tables) return batches;
  Problem black = problem;
  std::ranges::fill(black.ground_albedo, 0.0);
  std::vector<Batch> over_black = upload(black, rays, wavelengths_at_once, ground);
  for (std::size_t b = 0; b < batches.size(); ++b) {
    batches[b].black = std::move(over_black[b].scene);
  }
  return batches;
}

void Engine::Parts::trace_tiles(Tracer& tracer, const std::string& name,
                                const MethodOptions& options, const std::vector<Batch>& batches,
                                int rays,
                                const std::function<void(std::size_t, const Tile&)>& visit) {
  Method& m = method(name);
  Tracer on_ground = this->tracer("surface", tracer.watch);
  const UploadedScene& largest = batches.front().scene;
  int at_once = std::min(m.rays_at_once(largest, options, tracer.pacer), rays);
  const std::size_t bytes = Tile::bytes(m.description(), largest.groups(), at_once);
  const auto values = buffers.take(bytes, vulkan::Memory::host),
             black =
                 batches.front().black ? buffers.take(bytes, vulkan::Memory::host) : nullptr;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    const Batch& batch = batches[b];
    tracer.tables.give_up();
    for (int first = 0; first < rays; first += at_once) {
      Tile tile{first, std::min(at_once, rays - first), *values};
      m.trace(tracer, batch.scene, options, tile);
      if (batch.black) m.trace(tracer, *batch.black, options, {first, tile.rays, *black});
      if (batch.scene.ground_km()) {
        surface.light(on_ground, batch.scene, left_by(m, batch.scene.problem()), tile,
                      black ? *black : *values);
      }
      visit(b, tile);
      const double done = static_cast<double>(first + tile.rays) / rays;
      tracer.watch.progress((static_cast<double>(b) + done) /
                            static_cast<double>(batches.size()));
    }
  }
  tracer.device_ms += on_ground.device_ms;
}

auto Engine::Parts::trace_rays(const Problem& problem, const Rays& rays,
                               const std::string& method_name, const MethodOptions& options,
                               const Watch& watch) -> Traced {
  Traced traced;
  const std::vector<glm::dvec3>& directions = rays.directions;
  if (directions.empty()) return traced;
  std::vector<double> dark(problem.wavelengths_nm.size(), 0.0);
  traced.radiance.assign(directions.size(), dark);
  traced.transmittance.assign(directions.size(), dark);
  bool random = method(method_name).description().random;
  if (random) traced.standard_error.assign(directions.size(), dark);
  std::vector<Batch> batches = upload_with_ground(problem, rays, method_name, watch);
  Tracer tracer = this->tracer(method_name, watch);
  auto read = [&](std::size_t b, const Tile& tile) {
    const Batch& batch = batches[b];
    auto values = tile.values.as<const glm::vec4>();
    for (std::size_t w = 0; w < batch.wavelengths(); ++w) {
      for (int ray = 0; ray < tile.rays; ++ray) {
        auto value = [&](int quantity) -> double {
          std::size_t plane = quantity * batch.scene.groups() + w / 4;
          return values[plane * tile.rays + ray][static_cast<int>(w % 4)];
        };
        std::size_t at = tile.first_ray + ray;
        if (problem.scattering_orders != 0) {
          traced.radiance[at][batch.first + w] = value(0) + value(1);
        }
        traced.transmittance[at][batch.first + w] = value(2);
        if (random) traced.standard_error[at][batch.first + w] = value(3);
      }
    }
  };
  trace_tiles(tracer, method_name, options, batches, static_cast<int>(directions.size()), read);
  traced.device_ms = tracer.device_ms;
  return traced;
}

}  // namespace cyanometer
