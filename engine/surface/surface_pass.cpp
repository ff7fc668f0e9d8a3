#include "engine/surface/surface_pass.h"

#include "engine/fingerprint.h"
#include "engine/methods/tables/fill.h"
#include "engine/surface/maps.h"
#include "spirv/surface_distance.spv.h"
#include "spirv/surface_light.spv.h"

namespace cyanometer {
namespace {

struct DistancePush {
  std::int32_t first, end;
};
struct LightPush {
  std::int32_t first, end, first_ray, rays_in_tile, left;
};

/// Octaves of noise that a look at the terrain takes, as evaluations are counted.
constexpr std::int64_t a_look = 12;
/// Looks on a ray among heights, and towards the sun.
constexpr std::int64_t usual_looks = 60;

/// The images of a map on the device.
struct Texels : Tables {
  Texels(vulkan::Device& device, const std::vector<std::uint32_t>& texels)
      : buffer(device, 4 * texels.size(), vulkan::Memory::device) {
    buffer.write(0, std::as_bytes(std::span(texels)));
  }
  std::size_t bytes() const override { return buffer.size(); }

  vulkan::Buffer buffer;
};

vulkan::Specialization constants(const UploadedScene& scene) {
  vulkan::Specialization constants = scene.constants();
  constants.push_back(static_cast<std::uint32_t>(scene.problem().ground->kind));
  return constants;
}

}  // namespace

std::string ground_revision(const Scene& scene) {
  const Surface& surface = scene.planet.surface;
  if (std::holds_alternative<UniformSurface>(surface)) return {};
  static const std::string code = fingerprint(
      {reinterpret_cast<const char*>(surface_light_spirv), sizeof(surface_light_spirv)});
  const auto* map = std::get_if<MapSurface>(&surface);
  return map ? code + " " + surface_key(*map) : code;
}

SurfacePass::SurfacePass(vulkan::Device& device)
    : distance_(device, surface_distance_spirv, UploadedScene::bindings + 1,
                sizeof(DistancePush)),
      light_(device, surface_light_spirv, UploadedScene::bindings + 3, sizeof(LightPush)) {}

std::shared_ptr<const vulkan::Buffer> SurfacePass::texels(Tracer& tracer,
                                                          const Ground& ground) {
  if (!ground.images) return nullptr;
  auto texels = tracer.tables.get<Texels>("surface " + ground.images->key, [&] {
    return std::make_shared<const Texels>(tracer.device, *ground.images->texels);
  });
  return {texels, &texels->buffer};
}

vulkan::Buffer SurfacePass::distances(Tracer& tracer, const UploadedScene& scene, int rays) {
  vulkan::Buffer distances(tracer.device, sizeof(float) * rays, vulkan::Memory::host);
  fill_table(tracer, {distance_, constants(scene), scene.bind({distances})}, rays,
             a_look * (has_heights(scene.problem()) ? usual_looks : 1), DistancePush{});
  return distances;
}

void SurfacePass::light(Tracer& tracer, const UploadedScene& scene, Left left, const Tile& tile,
                        const vulkan::Buffer& black) {
  std::int64_t columns = (2 + scene.disc_points()) * evaluations_per_column(scene.problem()) *
                         std::max(scene.media(), 1);
  std::int64_t looks = has_heights(scene.problem()) ? usual_looks : 2;
  fill_table(tracer,
             {light_, constants(scene), scene.bind({tile.values, *scene.ground_km(), black})},
             tile.rays, a_look * looks + columns,
             LightPush{0, 0, tile.first_ray, tile.rays, static_cast<std::int32_t>(left)});
}

}  // namespace cyanometer
