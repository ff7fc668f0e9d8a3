// The named scenes.
#include <gmock/gmock.h>

#include <set>

#include "scene_testing.h"

namespace cyanometer {
namespace {

TEST(Presets, EachIsAScene) {
  for (const Preset& preset : presets()) {
    const auto error = refusal({{"preset", preset.name}});
    EXPECT_FALSE(error) << preset.name << ": " << error->what();
  }
}

TEST(Presets, EachHasAPlainNameATitleOfItsOwnAndASource) {
  std::set<std::string> titles;
  for (const Preset& preset : presets()) {
    EXPECT_THAT(preset.name, testing::MatchesRegex("[a-z][a-z0-9_]*"));
    EXPECT_FALSE(preset.title.empty()) << preset.name;
    EXPECT_TRUE(titles.insert(preset.title).second) << preset.title;
    EXPECT_GT(preset.source.size(), 20u) << preset.name;
  }
}

TEST(Presets, EarthIsTheFirstAndTheEmptyDocument) {
  EXPECT_EQ(presets().front().name, "earth");
  EXPECT_EQ(scene_of(R"({"preset": "earth"})"), scene_of("{}"));
  EXPECT_EQ(scene_of(R"({"preset": null})"), scene_of("{}"));
}

TEST(Presets, TheyHaveNoArraySpectra) {
  for (const Preset& preset : presets()) {
    const Json document = {{"preset", preset.name},
                           {"spectrum", {{"wavelengths_nm", "auto"}, {"colour", nullptr}}}};
    const auto error = refusal(document);
    EXPECT_FALSE(error) << preset.name << ": " << error->what();
  }
}

TEST(Presets, AnUnknownOneIsRefusedWithTheNamesThereAre) {
  const auto error = refusal({{"preset", "nowhere"}});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->pointer, "/preset");
  EXPECT_NE(error->allowed.find("\"earth\""), std::string::npos);
  EXPECT_EQ(refusal({{"preset", 1}})->pointer, "/preset");
  EXPECT_THROW(preset_document("nowhere"), std::out_of_range);
}

}  // namespace
}  // namespace cyanometer
