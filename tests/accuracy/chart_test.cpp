#include "engine/accuracy/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "engine/accuracy/chart_svg.h"
#include "engine/accuracy/comparison.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

ChartPoint point(const char* method, double error, double frame_ms, double tables_ms) {
  ChartPoint made;
  made.method = method;
  made.options = {{"view_nodes", 3}};
  made.error = {{error, 0, error, error}, error / 2, error * 2};
  made.frame_ms = frame_ms;
  made.fastest_ms = frame_ms / 2;
  made.slowest_ms = frame_ms * 2;
  made.tables_ms = tables_ms;
  return made;
}

ChartPoint failed() {
  ChartPoint made;
  made.method = "bruneton";
  made.failure = "too much <air> & \"more\"";
  return made;
}

ChartScene scene_of(std::vector<ChartPoint> points) {
  return {"a scene", nlohmann::json::object(), 512, 0, std::move(points)};
}

Chart small_chart() {
  return {"a device",
          "1.2.3",
          {{"first",
            {{"camera", {{"pitch_deg", 3}}}},
            512,
            0.002,
            {point("raymarch", 0.4, 1, 0), point("moments", 0.01, 2, 50), failed()}},
           {"empty", nlohmann::json::object(), 0, 0, {}}}};
}

TEST(Chart, FrontHasWhatNothingBeats) {
  ChartScene scene =
      scene_of({point("raymarch", 0.4, 10, 0), point("hillaire", 0.05, 4, 40),
                point("moments", 0.01, 12, 100), point("path", 0.1, 1000, 0), failed()});
  EXPECT_THAT(pareto_front(scene, 1), ElementsAre(0, 1, 2));
  EXPECT_THAT(pareto_front(scene, 10), ElementsAre(1, 2));
  EXPECT_THAT(pareto_front(scene_of({}), 1), ElementsAre());
  EXPECT_THAT(pareto_front(scene_of({failed()}), 1), ElementsAre());
}

TEST(Chart, AnErrorOfNoneByChanceBeatsNobodyByMoreThanItMayBe) {
  ChartPoint lucky = point("path", 0, 10, 0);
  lucky.error.high = 0.03;
  ChartScene scene = scene_of({point("hillaire", 0.05, 1, 0), lucky,
                               point("moments", 0.01, 20, 0), point("bruneton", 0.005, 40, 0)});
  EXPECT_EQ(told_error(scene, lucky), 0.03);
  EXPECT_THAT(pareto_front(scene, 1), ElementsAre(0, 1, 2, 3));
  scene.noise = 0.02;  // which tells the last two from nobody
  EXPECT_THAT(pareto_front(scene, 1), ElementsAre(0, 1, 2));
  scene.noise = 0.1;
  EXPECT_THAT(pareto_front(scene, 1), ElementsAre(0));
}

TEST(Chart, ReadsBackAsItWasWritten) {
  Chart chart = small_chart();
  EXPECT_EQ(chart_document(chart_from(chart_document(chart))), chart_document(chart));
}

TEST(Chart, PictureIsSelfContainedAndSaysWhatItWasGivenAsText) {
  std::string svg = chart_svg(small_chart());
  EXPECT_THAT(svg, Not(HasSubstr("href")));
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf\"")));
  EXPECT_EQ(svg.find("http"), svg.rfind("http")) << "but for its namespace";
  Chart hostile = small_chart();
  hostile.scenes[0].name = "</text><script>";
  EXPECT_THAT(chart_svg(hostile), Not(HasSubstr("<script")));
}

TEST(Chart, TableHasALineForEveryPointAndQuotesWhatNeedsIt) {
  std::string csv = chart_csv(small_chart());
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_THAT(csv, HasSubstr("\"too much <air> & \"\"more\"\"\""));
  EXPECT_THAT(csv, HasSubstr("\"first\",bruneton,\"{}\",,,,,,,,,,,,0.002,"));
}

TEST(Chart, KeepsOtherScenesAndPointsOfTheSame) {
  const Chart before = small_chart();
  Chart now{before.device, before.version, {}};
  now.scenes = {{"second", {{"camera", {{"pitch_deg", 4}}}}, 0, 0, {}},
                {"first again", before.scenes[0].document, 0, 0, {}}};
  take_over(before, now);
  ASSERT_EQ(now.scenes.size(), 4u);
  EXPECT_EQ(now.scenes[0].name, "first");
  EXPECT_EQ(now.scenes[1].name, "empty");
  EXPECT_TRUE(now.scenes[2].points.empty());
  EXPECT_EQ(now.scenes[3].name, "first again");
  EXPECT_EQ(now.scenes[3].points.size(), 3u);
  Chart changed{before.device, before.version, {{"first", {{"x", 1}}, 0, 0, {}}}};
  take_over(before, changed);
  ASSERT_EQ(changed.scenes.size(), 2u) << "a scene that is another now takes its old place";
  EXPECT_TRUE(changed.scenes[1].points.empty());
  Chart elsewhere{"another device", before.version, {}};
  take_over(before, elsewhere);
  EXPECT_TRUE(elsewhere.scenes.empty());
}

TEST(Chart, SettingsAreAllTheMethodsOptionsAndNoneTwice) {
  for (const MethodDescription& method : methods()) {
    auto settings = chart_settings(method);
    ASSERT_FALSE(settings.empty());
    for (const auto& each : settings) {
      EXPECT_EQ(each.size(), method.options.size()) << method.name;
      EXPECT_EQ(std::ranges::count(settings, each), 1) << method.name;
      for (const MethodOption& option : method.options) {
        EXPECT_GE(each.at(option.name), option.minimum);
        EXPECT_LE(each.at(option.name), option.maximum);
      }
    }
  }
}

TEST(Chart, ScenesHaveTheirProportionsAndWavelengths) {
  Scene wide = charted(read_scene({{"image", {{"width", 1600}, {"height", 800}}}}), 20000);
  EXPECT_EQ(wide.image.width, 2 * wide.image.height);
  EXPECT_EQ(wide.spectrum.wavelengths_nm.size(), 3u);
  EXPECT_EQ(read_scene(canonical(wide)), wide);
  for (const char* projection : {"fisheye", "equirectangular", "cubemap"}) {
    Scene scene = charted(read_scene({{"camera", {{"projection", projection}}}}), 20000);
    EXPECT_NEAR(scene.image.width * scene.image.height, 20000, 1000) << projection;
    EXPECT_EQ(read_scene(canonical(scene)), scene) << projection;
  }
}

/// One engine, few rays, small frames.
TEST(Chart, MeasuresEachPointOnceAndGoesOn) {
  testing::TemporaryFolder folder;
  Engine& engine = device();
  ChartSettings settings;
  settings.reference = {64, 0.05, 256};
  settings.references = folder.path();
  settings.pixels = 256;
  settings.methods = {"raymarch", "moments"};
  Scene scene = charted(read_scene({{"method", {{"scattering_orders", 1}}}}), settings.pixels);
  ChartScene chart{"noon", canonical(scene), 0, 0, {}};
  int measured = 0;
  auto count = [&](const ChartPoint&) { ++measured; };
  settings.methods = {"raymarch"};
  measure_points(engine, settings, {}, count, chart);
  int of_raymarch = measured;
  settings.methods = {"raymarch", "moments"};
  measure_points(engine, settings, {}, count, chart);
  EXPECT_EQ(measured, static_cast<int>(chart.points.size()));
  EXPECT_GT(measured, of_raymarch);
  for (const ChartPoint& each : chart.points) {
    EXPECT_TRUE(each.failure.empty()) << each.failure;
    EXPECT_GT(each.frame_ms, 0);
    EXPECT_LE(each.fastest_ms, each.frame_ms);
    EXPECT_LE(each.frame_ms, each.slowest_ms);
    // The march of one order against that of the reference.
    EXPECT_LT(each.error.measure.error, 0.02) << each.method;
  }
  EXPECT_LT(chart.points[of_raymarch - 1].error.measure.error, 1e-5) << "the finest march";
  settings.methods = {"raymarch"};
  settings.reference.rays = 32;
  measured = 0;
  measure_points(engine, settings, {}, count, chart);
  EXPECT_EQ(measured, of_raymarch) << "another reference";
  EXPECT_EQ(chart.points.size(), static_cast<std::size_t>(of_raymarch));
}

/// Of the one order that has no noise, so that both hold it against the same.
TEST(Chart, MeasuresColoursAsCompareDoes) {
  auto scene_by = [](const nlohmann::json& method) {
    nlohmann::json document{
        {"spectrum", {{"wavelengths_nm", {460, 530, 570, 640, 800}}, {"colour", "cie"}}},
        {"image", {{"width", 32}, {"height", 18}}},
        {"method", method}};
    document["method"]["scattering_orders"] = 1;
    return read_scene(document);
  };
  const Scene coarse =
      scene_by({{"name", "nishita"}, {"view_samples", 6}, {"light_samples", 3}});
  const Scene exact = scene_by({{"name", "raymarch"}, {"view_nodes", 32}});
  std::vector<int> pixels(32 * 18);
  std::iota(pixels.begin(), pixels.end(), 0);
  const Reference reference =
      make_reference(device(), exact, pixel_directions(exact, pixels), {}, "");
  const ChartPoint charted =
      measure_point(device(), exact, reference, "nishita", coarse.method.options, {}, {});
  const double compared = compare(render_pair(device(), coarse, exact)).measure.error;
  EXPECT_GT(compared, 0.02);
  EXPECT_NEAR(charted.error.measure.error, compared, 1e-3 * compared);
}

}  // namespace
}  // namespace cyanometer
