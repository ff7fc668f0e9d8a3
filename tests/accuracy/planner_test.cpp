// What plans promise of scenes whose like they were made for, and where nothing meets what is
// asked.
#include "engine/planner/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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

/// Optical depths at three wavelengths, of all constituents that have one.
std::map<std::string, std::vector<double>> extinction_of(const Scene& scene) {
  std::map<std::string, std::vector<double>> result;
  for (const Medium& medium : make_problem(scene, {440, 550, 680}).media) {
    for (std::size_t w = 0; w < 3; ++w)
      result[medium.name].push_back(medium.scattering_per_km[w] + medium.absorption_per_km[w]);
  }
  return result;
}

TEST(Nearby, HasAsMuchOfEachConstituentOrATwelfthMore) {
  json visible{{"atmosphere",
                {{"constituents",
                  {{"aerosol",
                    {{"optical_depth", nullptr},
                     {"single_scattering_albedo", nullptr},
                     {"visibility_km", 23}}}}}}}};
  for (const json& document :
       {json::object(), json{{"preset", "mars"}}, json{{"preset", "titan"}},
        json{{"preset", "earth_smoke"}}, json{{"preset", "gas_mixture"}},
        json{{"preset", "thesis_defaults"}}, visible}) {
    const Scene scene = read_scene(document);
    const auto there = extinction_of(scene), near = extinction_of(nearby(scene));
    ASSERT_EQ(there.size(), near.size()) << document;
    for (const auto& [name, depths] : there) {
      for (std::size_t w = 0; w < depths.size(); ++w) {
        EXPECT_GE(near.at(name)[w], depths[w] * (1 - 1e-6)) << document << name;
        EXPECT_LE(near.at(name)[w], depths[w] * 1.081) << document << name;
      }
    }
  }
}

TEST(Nearby, AirThatChangesALittleIsMostlyPlannedAsOne) {
  int plans = 0;
  Scene before;
  for (double pressure_pa = 80000; pressure_pa < 101000; pressure_pa += 200) {
    const Scene near = nearby(read_scene(
        {{"atmosphere", {{"constituents", {{"air", {{"pressure_pa", pressure_pa}}}}}}}}));
    plans += canonical(near) != canonical(before) || plans == 0;
    before = near;
  }
  EXPECT_LE(plans, 4);
  EXPECT_GE(plans, 3);
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
