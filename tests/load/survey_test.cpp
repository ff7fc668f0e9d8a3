// A survey: what it asks for, that it goes on where it was, and what is written of it.
#include "server/load/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "engine/scene/document.h"
#include "server/load/survey_words.h"
#include "tests/load/fake_daemon.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

SurveySettings small_survey() {
  SurveySettings settings;
  settings.seconds = 0.02;
  settings.clients = {1, 2};
  settings.sizes = {{16, 9}, {32, 18}};
  settings.formats = {"png", "jpeg"};
  settings.vary = {"camera", "nothing"};
  settings.presets = {"mars"};
  return settings;
}

/// Whose pixels take 3 ms to store.
SurveyedDaemon surveyed(const FakeDaemon& daemon) {
  return {daemon.origin(), 0, [](const Image&) { return 3.0; }};
}

Survey measured(const FakeDaemon& daemon, const SurveySettings& settings) {
  Survey survey{"a device", "1.2.3", {}, {}};
  measure_rates(
      surveyed(daemon), settings, {}, [](const SurveyPoint&) {}, survey);
  measure_errors(
      surveyed(daemon), settings, {}, [](const SurveyError&) {}, survey);
  return survey;
}

TEST(Survey, MeasuresEveryClassOnceAndThenNothing) {
  FakeDaemon daemon;
  const SurveySettings settings = small_survey();
  Survey survey = measured(daemon, settings);
  EXPECT_EQ(survey.points.size(), 16u);
  EXPECT_EQ(survey.errors.size(), 8u);
  std::set<std::string> classes;
  for (const SurveyPoint& point : survey.points) {
    classes.insert(words_of({point.width, point.height}) + point.format + point.vary +
                   std::to_string(point.clients));
    EXPECT_GT(point.frames_per_s, 0);
  }
  EXPECT_EQ(classes.size(), 16u);
  const std::size_t frames = daemon.frames;
  const auto never = [](const auto&) { FAIL(); };
  measure_rates(surveyed(daemon), settings, {}, never, survey);
  measure_errors(surveyed(daemon), settings, {}, never, survey);
  EXPECT_EQ(daemon.frames, frames);
}

TEST(Survey, GoesOnWhereItWasStopped) {
  FakeDaemon daemon;
  const SurveySettings settings = small_survey();
  Survey survey;
  struct Enough {};
  const auto stop_after_five = [&](const SurveyPoint&) {
    if (survey.points.size() == 5) throw Enough{};
  };
  EXPECT_THROW(measure_rates(surveyed(daemon), settings, {}, stop_after_five, survey), Enough);
  EXPECT_EQ(missing_points(settings, survey).size(), 11u);
  std::size_t more = 0;
  measure_rates(
      surveyed(daemon), settings, {}, [&](const SurveyPoint&) { ++more; }, survey);
  EXPECT_EQ(more, 11u);
}

TEST(Survey, EndsWhenItsTimeIsOver) {
  FakeDaemon daemon;
  Survey survey;
  Watch watch;
  watch.deadline = std::chrono::steady_clock::now();
  EXPECT_THROW(measure_rates(surveyed(daemon), small_survey(), watch, {}, survey), Cancelled);
  EXPECT_THROW(measure_errors(surveyed(daemon), small_survey(), watch, {}, survey), Cancelled);
  EXPECT_EQ(daemon.frames, 0u);
}

TEST(Survey, AsksForFramesOfEachClassThatItNeverHadBefore) {
  FakeDaemon daemon;
  SurveySettings settings = small_survey();
  settings.vary = {"camera", "sun", "atmosphere", "everything"};
  settings.presets.clear();
  measured(daemon, settings);
  std::set<std::string> scenes;
  for (const json& scene : daemon.scenes()) {
    scenes.insert(canonical(read_scene(scene)).dump());
  }
  EXPECT_EQ(scenes.size(), daemon.scenes().size());
}

TEST(Survey, TheFloorIsThatOfStoringPixelsAndOfEncodingAPicture) {
  FakeDaemon daemon;
  const Survey survey = measured(daemon, small_survey());
  for (const SurveyPoint& point : survey.points) {
    if (point.vary == "nothing") {
      EXPECT_EQ(point.floor_ms(), point.floor.answer_ms);
    } else {
      EXPECT_EQ(point.floor_ms(), 3 + 1);
      EXPECT_NEAR(point.over_floor(), 1000 / point.frames_per_s / 4, 1e-9);
    }
  }
  EXPECT_EQ(SurveyPoint{}.over_floor(), 0);
}

TEST(Survey, SizesThatGetTheSameMethodShareAnError) {
  FakeDaemon daemon;
  const Survey survey = measured(daemon, small_survey());
  EXPECT_EQ(daemon.judged, 4u);  // the scene and a preset, two ways to vary
  for (const SurveyError& error : survey.errors) {
    EXPECT_EQ(error.error, 0.004);
    EXPECT_EQ(error.low, 0.003);
    EXPECT_EQ(error.method, "fake grain=3");
  }
}

/// Scenes go to the judge as links, which must not be too long for a request.
TEST(Survey, EveryUsualPresetIsJudgedHoweverItVaries) {
  FakeDaemon daemon;
  SurveySettings settings;
  settings.sizes = {{16, 9}};
  Survey survey;
  EXPECT_GE(settings.presets.size(), 10u);
  measure_errors(
      surveyed(daemon), settings, {}, [](const SurveyError&) {}, survey);
  EXPECT_EQ(survey.errors.size(), 5 * (settings.presets.size() + 1));
  EXPECT_EQ(daemon.judged, survey.errors.size());
}

TEST(Survey, PresetsAreJudgedByTheMethodThatTheSceneAsksFor) {
  FakeDaemon daemon;
  SurveySettings settings = small_survey();
  settings.scene = {{"method", {{"name", "raymarch"}, {"scattering_orders", 1}}}};
  Survey survey;
  measure_errors(
      surveyed(daemon), settings, {}, [](const SurveyError&) {}, survey);
  for (const json& scene : daemon.scenes()) {
    EXPECT_EQ(read_scene(scene).method.name, "raymarch");
    EXPECT_EQ(read_scene(scene).image.format, ImageFormat::exr);
  }
}

TEST(Survey, PointsAndErrorsReadBack) {
  FakeDaemon daemon;
  const Survey survey = measured(daemon, small_survey());
  const json point = survey.points.front(), error = survey.errors.front();
  EXPECT_EQ(json(point.get<SurveyPoint>()), point);
  EXPECT_EQ(json(error.get<SurveyError>()), error);
}

/// One point of each kind that a report may show.
Survey known_survey() {
  SurveyPoint slow;
  slow.width = 64, slow.height = 36, slow.format = "png", slow.vary = "sun", slow.clients = 1;
  slow.frames_per_s = 20, slow.floor = {8, 2, 0.1}, slow.stated_error = 0.015;
  SurveyPoint fast = slow;
  fast.clients = 4, fast.frames_per_s = 40, fast.failed = 3;
  SurveyPoint none = slow;
  none.vary = "nothing", none.frames_per_s = 0;
  return {"a <device>",
          "1.2.3",
          {slow, none, fast},
          {{"", "sun", 64, 36, "auto", 0.02, 0.01, 0.008, 0.012},
           {"mars", "sun", 64, 36, "auto", 0.02, 0.03, 0.02, 0.04}}};
}

TEST(SurveyTable, ShowsTheBestItsRatioAndTheErrorBesideIt) {
  const std::string table = survey_table(known_survey(), {});
  EXPECT_THAT(table, HasSubstr("| 64 x 36 | sun moves | 40.0 (2.50 x) | 3 % |"));
  EXPECT_THAT(table, HasSubstr("| sun moves | 1 | 20.0 | 10.0 | 5.00 |"));
  EXPECT_THAT(table, HasSubstr("1.5 % | 3 % | 3 failed |"));
  EXPECT_THAT(table, HasSubstr("| 64 x 36 | sun moves | 2 | 2 % | 3 % | 3 % | mars |"));
  EXPECT_THAT(table,
              HasSubstr("| the scene | sun moves | 64 x 36 | 2 % | 1 % | 0.8 % to 1.2 % |"));
}

TEST(SurveyTable, AnErrorThatNoiseHidesIsNotSaidToBeNone) {
  Survey survey = known_survey();
  survey.errors = {{"titan", "sun", 64, 36, "auto", 0.02, 0, 0, 0.042}};
  const std::string table = survey_table(survey, {});
  EXPECT_THAT(table, HasSubstr("| 2 % | < 4.2 % | 0 % to 4.2 % |"));
  EXPECT_THAT(table, HasSubstr("40.0 (2.50 x) | < 4.2 % |"));
}

TEST(SurveyTable, RowsHaveAsManyCellsAsTheirHeads) {
  std::istringstream lines(survey_table(known_survey(), {}));
  std::ptrdiff_t cells = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto found = std::ranges::count(line, '|');
    if (cells > 0 && found > 0) {
      EXPECT_EQ(found, cells) << line;
    }
    cells = found;
  }
}

TEST(SurveySvg, IsOneSelfContainedPicture) {
  const std::string svg = survey_svg(known_survey());
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  EXPECT_THAT(svg, HasSubstr("a &lt;device&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("href")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, HasSubstr("2.50 x"));
  EXPECT_THAT(survey_svg({}), ::testing::EndsWith("</svg>\n"));
}

TEST(SurveySvg, ABarEndsWhereItsFramesDo) {
  const auto bar_of = [](double frames_per_s) {
    Survey survey = known_survey();
    survey.points.back().frames_per_s = frames_per_s;
    const std::string svg = survey_svg(survey), field = "width=\"";
    return std::stod(svg.substr(svg.find(field, svg.find("class=\"bar sun")) + field.size()));
  };
  // A decade from 10 to 100, whatever else there is.
  EXPECT_NEAR(bar_of(80) - bar_of(40), bar_of(40) - bar_of(20), 1e-3);
  EXPECT_GT(bar_of(80), bar_of(40));
}

}  // namespace
}  // namespace cyanometer::testing
