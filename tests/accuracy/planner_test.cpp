// What plans promise of scenes whose like they were made for, and where nothing meets what is
// asked.
#include "engine/planner/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/planner/nearby.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

TEST(Nearby, HasAsManyPixelsOrAFifthMore) {
  for (auto [width, height] : {std::pair{1600, 900}, {800, 450}, {1920, 1080}, {17, 3}}) {
    const Scene scene = read_scene({{"image", {{"width", width}, {"height", height}}}});
    const Image image = nearby(scene).image;
    const double more = static_cast<double>(image.width) * image.height / (width * height);
    EXPECT_GE(more, 1) << width;
    EXPECT_LE(more, width > 100 ? 1.2 : 1.5) << width;
  }
}

/// A sliver of the air in the corner of a frame that looks into space.
json over_the_limb() {
  return {{"camera", {{"altitude_km", 36000}, {"pitch_deg", -77.45}, {"fov_deg", 8}}},
          {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
          {"image", {{"width", 320}, {"height", 180}}},
          {"method", {{"name", "hillaire"}}}};
}

TEST(Nearby, SeesWhatItsFrameSees) {
  const auto seen = [](const Scene& scene) {
    const auto pixels = measured_pixels(scene);
    return static_cast<double>(std::ranges::count(pixels, true)) /
           static_cast<double>(pixels.size());
  };
  for (double pitch_deg : {-82.0, -79.3, -77.45}) {
    json document = over_the_limb();
    document["camera"]["pitch_deg"] = pitch_deg;
    const Scene scene = read_scene(document);
    EXPECT_GT(seen(nearby(scene)), 0.7 * seen(scene)) << pitch_deg;
    EXPECT_LT(seen(nearby(scene)), 1.4 * seen(scene)) << pitch_deg;
  }
}

TEST(Planner, StatesTheErrorOfTheLittleThatAFrameSees) {
  EXPECT_GT(device().plan(read_scene(over_the_limb())).expected_error, 0.01);
}

TEST(Planner, TakesFewerWavelengthsWhereOnlyTimeIsAskedAndThereIsLittle) {
  json document{{"preset", "earth_low_sun"},
                {"image", {{"width", 64}, {"height", 36}}},
                {"method", {{"max_ms", 1e6}}}};
  const Plan unhurried = device().plan(read_scene(document));
  EXPECT_TRUE(unhurried.met);
  EXPECT_GT(unhurried.wavelengths_nm.size(), 4);
  document["method"]["max_ms"] = 1e-3;
  const Plan hurried = device().plan(read_scene(document));
  EXPECT_FALSE(hurried.met);
  EXPECT_EQ(hurried.wavelengths_nm.size(), 4);
}

TEST(Planner, WalksOverAVariedGroundWhereTablesMissWhatIsAsked) {
  json document{{"planet", {{"surface", {{"type", "procedural"}}}}},
                {"camera", {{"altitude_km", 408}, {"pitch_deg", -27}, {"fov_deg", 55}}},
                {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                {"image", {{"width", 160}, {"height", 90}}},
                {"method", {{"max_error", 0.08}}}};
  const Plan near = device().plan(read_scene(document));
  EXPECT_EQ(near.method, "path") << near.why;
  EXPECT_TRUE(near.met) << near.why;
  document["method"]["max_error"] = 0.25;
  const Plan far = device().plan(read_scene(document));
  EXPECT_NE(far.method, "path") << far.why;
  EXPECT_TRUE(far.met) << far.why;
}

}  // namespace
}  // namespace cyanometer
