#include "engine/methods/tables/optical_depth_table.h"

#include <algorithm>

#include "spirv/optical_depth.spv.h"

namespace cyanometer {
namespace {

struct Push {
  std::int32_t first_texel, end_texel, first_medium, end_medium;
};

/// Evaluations of the density that the column of one constituent may take, both parts of the
/// ray together: 8 nodes a part, or 8 between any two nodes of a tabulated profile.
std::int64_t evaluations_per_column(const Problem& problem) {
  std::size_t pieces = 1;
  for (const Medium& medium : problem.media) {
    if (auto* table = std::get_if<TableProfile>(&medium.profile)) {
      pieces = std::max(pieces, table->altitude_km.size() + 1);
    }
  }
  return static_cast<std::int64_t>(16 * pieces);
}

/// Constituents whose columns together stay below the drivers' limit on loops: a piece of a
/// profile is a round, whose quadrature is unrolled.
int media_at_once(std::int64_t evaluations_per_column) {
  return static_cast<int>(
      std::max<std::int64_t>(most_loop_iterations / evaluations_per_column, 1));
}

}  // namespace

OpticalDepthTable::OpticalDepthTable(vulkan::Device& device, OpticalDepthSize size, int groups)
    : values_(device, sizeof(float) * 4 * size.cosines * size.altitudes * groups,
              vulkan::Memory::device) {}

vulkan::Specialization OpticalDepthTable::constants(const UploadedScene& scene,
                                                    OpticalDepthSize size) {
  vulkan::Specialization constants = scene.constants();
  constants.push_back(static_cast<std::uint32_t>(size.cosines));
  constants.push_back(static_cast<std::uint32_t>(size.altitudes));
  return constants;
}

OpticalDepthTableMaker::OpticalDepthTableMaker(vulkan::Device& device)
    : kernel_(device, optical_depth_spirv, UploadedScene::bindings + 1, sizeof(Push)) {}

std::shared_ptr<const OpticalDepthTable> OpticalDepthTableMaker::get(Tracer& tracer,
                                                                     const UploadedScene& scene,
                                                                     OpticalDepthSize size) {
  std::string key = "optical depth " + std::to_string(size.cosines) + " " +
                    std::to_string(size.altitudes) + " " + scene.air_key();
  return tracer.tables.get<OpticalDepthTable>(key, [&] { return make(tracer, scene, size); });
}

std::shared_ptr<const OpticalDepthTable> OpticalDepthTableMaker::make(
    Tracer& tracer, const UploadedScene& scene, OpticalDepthSize size) {
  auto table = std::make_shared<OpticalDepthTable>(tracer.device, size, scene.groups());
  std::vector<vulkan::Binding> bindings = scene.bind({table->values()});
  vulkan::Specialization constants = OpticalDepthTable::constants(scene, size);
  int texels = size.cosines * size.altitudes, media = std::max(scene.media(), 1);
  std::int64_t column = evaluations_per_column(scene.problem());
  int media_step = std::min(media_at_once(column), media);
  std::int64_t texel = column * media_step;
  for (int first = 0; first < texels;) {
    std::int64_t fit = std::max<std::int64_t>(tracer.pacer.evaluations() / texel / 64 * 64, 64);
    int end = static_cast<int>(std::min<std::int64_t>(texels, first + fit));
    for (int medium = 0; medium < media; medium += media_step) {
      Push push{first, end, medium, std::min(media, medium + media_step)};
      tracer.commands.dispatch(kernel_, constants, bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(end - first, 64)});
      tracer.pacer.took(texel * (end - first), tracer.submit());
    }
    first = end;
  }
  return table;
}

}  // namespace cyanometer
