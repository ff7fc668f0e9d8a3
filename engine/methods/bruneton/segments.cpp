#include "engine/methods/bruneton/segments.h"

#include <stdexcept>

#include "engine/methods/tables/fill.h"
#include "spirv/bruneton_segment.spv.h"

namespace cyanometer::bruneton {
namespace {

struct Push {
  std::int32_t first, end, first_ray, rays_in_tile, multiple;
};

void expect_tables_of_all_places(const Problem& problem, const Setup& setup) {
  if (setup.gathered_view || setup.first == Setup::First::quadrature) {
    throw std::invalid_argument("the tables must hold for every altitude and sun");
  }
  if (problem.scattering_orders == 0) throw std::invalid_argument("no order is asked for");
}

}  // namespace

Segments::Segments(vulkan::Device& device)
    : kernel_(device, bruneton_segment_spirv, UploadedScene::bindings + 7, sizeof(Push)) {}

void Segments::trace(Tracer& tracer, TableMaker& maker, const UploadedScene& scene,
                     const Setup& setup, const vulkan::Buffer& ends_km, const Tile& tile) {
  expect_tables_of_all_places(scene.problem(), setup);
  auto single = maker.single(tracer, scene, setup);
  bool multiple = has_multiple(scene.problem());
  auto view = multiple ? maker.view(tracer, scene, setup) : nullptr;
  auto bindings =
      scene.bind({single->rays.grids, single->rays.nodes, single->values, single->particles,
                  multiple ? view->values : single->values, ends_km, tile.values});
  constexpr int evaluations = 80;  // of the density, that a table read from both ends is worth
  fill_table(tracer, {kernel_, view_constants(scene, setup, single->rays.rays), bindings},
             tile.rays, std::int64_t{evaluations} * scene.media() * scene.groups(),
             Push{0, 0, tile.first_ray, tile.rays, multiple});
}

}  // namespace cyanometer::bruneton
