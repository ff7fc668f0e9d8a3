// How fast a device is: measured once, kept, and planned by.
#include "engine/planner/profile.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"

namespace cyanometer {
namespace {

using testing::TemporaryFolder;

TEST(DeviceProfile, IsKeptUnderItsDevice) {
  TemporaryFolder folder;
  DeviceProfile profile{{{"raymarch", 1234.5}}};
  ASSERT_TRUE(save_profile(folder / "deep" / "er", "a device", profile));
  auto kept = load_profile(folder / "deep" / "er", "a device");
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->evaluations_per_ms, profile.evaluations_per_ms);
  EXPECT_EQ(kept->pace("moments"), DeviceProfile::nominal);
  EXPECT_FALSE(load_profile(folder / "deep" / "er", "another"));
  EXPECT_FALSE(load_profile("", "a device"));
  EXPECT_FALSE(save_profile("", "a device", profile));
}

TEST(DeviceProfile, ThatCannotBeReadIsNone) {
  TemporaryFolder folder;
  ASSERT_TRUE(save_profile(folder.path(), "a device", {}));
  std::filesystem::path file = std::filesystem::directory_iterator(folder.path())->path();
  for (const char* text :
       {"", "[]", "{}", R"({"device": "a device", "evaluations_per_ms": {"raymarch": -1}})",
        R"({"device": "a device", "evaluations_per_ms": {"raymarch": "fast"}})"}) {
    std::ofstream(file) << text;
    EXPECT_FALSE(load_profile(folder.path(), "a device")) << text;
  }
}

TEST(DeviceProfile, DecidesWhatFitsIntoATime) {
  TemporaryFolder folder;
  const nlohmann::json document{{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                                {"image", {{"width", 320}, {"height", 180}}},
                                {"method", {{"max_ms", 50}}}};
  Scene scene = read_scene(document);
  EngineOptions options;
  options.profiles = folder.path();
  Engine engine(options);
  std::string identity = engine.device().name + ", " + engine.device().driver + ", " +
                         engine.device().api_version + ", " + version();
  auto plan_at = [&](double evaluations_per_ms) {
    DeviceProfile profile;
    for (const MethodDescription& method : methods()) {
      profile.evaluations_per_ms[method.name] = evaluations_per_ms;
    }
    EXPECT_TRUE(save_profile(folder.path(), identity, profile));
    return Engine(options).plan(scene);
  };
  Plan slow = plan_at(1e4), fast = plan_at(1e8);
  EXPECT_FALSE(slow.met) << slow.why;
  EXPECT_TRUE(fast.met) << fast.why;
  EXPECT_LE(fast.expected_ms, 50);
  EXPECT_LT(fast.expected_error, slow.expected_error);
}

}  // namespace
}  // namespace cyanometer
