#include "engine/methods/tables/optical_depth_table.h"

#include <algorithm>

#include "engine/methods/tables/fill.h"
#include "spirv/optical_depth.spv.h"

namespace cyanometer {
namespace {

struct OpticalDepthPush {
  std::int32_t first, end, first_medium, end_medium;
};

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
    : kernel_(device, optical_depth_spirv, UploadedScene::bindings + 1,
              sizeof(OpticalDepthPush)) {}

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
  int media = std::max(scene.media(), 1);
  int at_once = std::min(columns_at_once(scene.problem()), media);
  for (int medium = 0; medium < media; medium += at_once) {
    OpticalDepthPush push{0, 0, medium, std::min(media, medium + at_once)};
    fill_table(tracer, {kernel_, constants, bindings}, size.cosines * size.altitudes,
               evaluations_per_column(scene.problem()) * at_once, push);
  }
  return table;
}

}  // namespace cyanometer
