#include "engine/methods/hillaire/sky_tracer.h"

#include "engine/methods/tables/fill.h"
#include "spirv/hillaire_pixels.spv.h"

namespace cyanometer::hillaire {
namespace {

struct TracerPush {
  std::int32_t first, end, first_ray, rays_in_tile, all_orders;
};

}  // namespace

SkyTracer::SkyTracer(vulkan::Device& device)
    : pixels_(device, hillaire_pixels_spirv, UploadedScene::bindings + 7, sizeof(TracerPush)),
      most_bytes_(device.limits().max_storage_range) {}

bool SkyTracer::serves(const UploadedScene& scene, const Sizes& sizes) const {
  const Problem& problem = scene.problem();
  return problem.sun_distance_km == 0 && scene.disc_points() == 1 &&
         problem.camera.altitude_km <= problem.thickness_km &&
         SkyView::bytes_of(scene, sizes) <= most_bytes_;
}

void SkyTracer::trace(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes,
                      const TablesOfView& tables, const Tile& tile) {
  vulkan::Specialization specialization = constants(scene, sizes);
  auto bindings =
      bind(scene, *tables.air, {tables.columns->values, tables.sky->values, tile.values});
  TracerPush push{0, 0, tile.first_ray, tile.rays, sizes.several_orders()};
  std::int64_t columns =
      sizes.stops > 1 ? evaluations_per_column(scene.problem()) * scene.media() : 0;
  fill_table(tracer, {pixels_, specialization, bindings}, tile.rays,
             6 * evaluations_per_node(scene) + columns, push);
}

}  // namespace cyanometer::hillaire
