#include "engine/accuracy/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/accuracy/chart_svg.h"
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
  std::vector<ChartPoint> points{point("raymarch", 0.4, 10, 0), point("hillaire", 0.05, 4, 40),
                                 point("moments", 0.01, 12, 100), point("path", 0.1, 1000, 0),
                                 failed()};
  EXPECT_THAT(pareto_front(points, 1), ElementsAre(0, 1, 2));
  EXPECT_THAT(pareto_front(points, 10), ElementsAre(1, 2));
  EXPECT_THAT(pareto_front({}, 1), ElementsAre());
  EXPECT_THAT(pareto_front({failed()}, 1), ElementsAre());
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
}

}  // namespace
}  // namespace cyanometer
