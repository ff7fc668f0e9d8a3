// Every preset through every method, as small frames: each has kernels of its own, which take
// most of the time.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/methods/method.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json small_frame(const std::string& preset, const std::string& method) {
  json document = {{"preset", preset}, {"method", {{"name", method}}}};
  const bool cube = preset_document(preset).value(json::json_pointer("/camera/projection"),
                                                  "perspective") == "cubemap";
  document["image"] = {{"width", cube ? 8 : 32},
                       {"height", cube ? 48 : 16},
                       {"format", "npy"},
                       {"channels", "spectral"}};
  return document;
}

class EveryPreset : public testing::TestWithParam<std::string> {};

TEST_P(EveryPreset, IsFiniteAndNotNegativeByEveryMethod) {
  std::vector<std::string> names{"auto"};
  for (const MethodDescription& method : methods()) names.push_back(method.name);
  for (const std::string& method : names) {
    const Frame frame = device().render(read_scene(small_frame(GetParam(), method)));
    for (const auto& plane : frame.planes) {
      for (int pixel = 0; pixel < frame.width * frame.height; ++pixel) {
        ASSERT_TRUE(std::isfinite(plane.samples[pixel])) << method << ", pixel " << pixel;
        ASSERT_GE(plane.samples[pixel], 0) << method << ", pixel " << pixel;
      }
    }
  }
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Presets, EveryPreset, testing::ValuesIn(preset_names()),
                         [](const auto& preset) { return preset.param; });

}  // namespace
}  // namespace cyanometer
