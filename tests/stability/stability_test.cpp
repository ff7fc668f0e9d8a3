// Every row of the suite at its hardest, and what the reports make of the findings. The whole
// sweeps are run by `cyanometer stability`.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "engine/stability/report.h"
#include "engine/stability/suite.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

/// The methods share the references, which take most of the time.
StabilityPoint at_its_hardest(const StabilityRow& row, const std::string& method) {
  static const testing::TemporaryFolder references;
  return measure_point(device(), row, method, row.hardest,
                       {.references = references.path(), .most_work = 1 << 17});
}

std::string in_words(const StabilityPoint& point) {
  return name_of(point.outcome) + ", " + std::to_string(point.value) + " " + point.note;
}

bool fails(const StabilityPoint& point) {
  return point.outcome == Outcome::degrades || point.outcome == Outcome::breaks;
}

const MethodDescription& description_of(const std::string& method) {
  return *std::ranges::find(methods(), method, &MethodDescription::name);
}

bool declares(const MethodDescription& method, int row) {
  return std::ranges::any_of(method.limits, [&](const MethodLimit& limit) {
    return std::ranges::find(limit.rows, row) != limit.rows.end();
  });
}

class Row : public ::testing::TestWithParam<int> {};

/// One test a row, so that processes which share the rows make each reference once.
TEST_P(Row, IsHeldByPathRaymarchAndAutoAndByTheOthersOrAmongTheirLimits) {
  const StabilityRow& row = stability_rows().at(static_cast<std::size_t>(GetParam() - 1));
  for (const char* name : {"path", "raymarch", "auto"}) {
    StabilityPoint point = at_its_hardest(row, name);
    EXPECT_FALSE(fails(point)) << name << ": " << in_words(point) << ", stated "
                               << point.stated;
  }
  for (const char* name : {"nishita", "hillaire", "bruneton", "moments"}) {
    StabilityPoint point = at_its_hardest(row, name);
    EXPECT_NE(point.outcome, Outcome::breaks) << name << ": " << in_words(point);
    EXPECT_TRUE(!fails(point) || declares(description_of(name), row.number))
        << name << ": " << in_words(point);
  }
}

std::string short_name(const ::testing::TestParamInfo<int>& row) {
  std::string name = stability_rows().at(static_cast<std::size_t>(row.param - 1)).name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return std::to_string(row.param) + name;
}
INSTANTIATE_TEST_SUITE_P(Stability, Row, ::testing::Range(1, 26), short_name);

TEST(Stability, HasEachRowOnceInOrder) {
  ASSERT_EQ(stability_rows().size(), 25u);
  for (int i = 0; i < 25; ++i) {
    const StabilityRow& row = stability_rows()[static_cast<std::size_t>(i)];
    EXPECT_EQ(row.number, i + 1);
    EXPECT_NE(std::ranges::find(row.sweep, row.hardest), row.sweep.end()) << row.name;
  }
}

TEST(Stability, LimitsAreNearWhereTheirSceneIs) {
  auto near = [](double sun_deg, const char* method) {
    Scene scene = read_scene({{"sun", {{"elevation_deg", sun_deg}}}});
    return limits_near(scene, method).size();
  };
  EXPECT_GT(near(-9, "moments"), near(40, "moments"));
  EXPECT_GT(near(0, "nishita"), near(40, "nishita"));
  EXPECT_TRUE(
      limits_near(read_scene({{"method", {{"scattering_orders", 1}}}}), "raymarch").empty());
  EXPECT_FALSE(limits_near(read_scene(nlohmann::json::object()), "raymarch").empty());
}

StabilityReport some_findings() {
  StabilityReport report{"a device", "1.0", {}};
  auto add = [&](const char* method, double trigger, Outcome outcome, double value) {
    report.points.push_back({.row = 13,
                             .method = method,
                             .trigger = trigger,
                             .outcome = outcome,
                             .value = value,
                             .least = value});
  };
  add("moments", 0.9, Outcome::holds, 0.01);
  add("moments", 0.95, Outcome::degrades, 0.2);
  add("moments", 0.99, Outcome::degrades, 0.1);
  add("bruneton", 0.9, Outcome::degrades, 0.5);
  add("bruneton", 0.95, Outcome::breaks, 0);
  add("path", 0.9, Outcome::reference, 0);
  return report;
}

TEST(Stability, ACellIsItsWorstPoint) {
  StabilityReport report = some_findings();
  StabilityCell moments = cell_of(report, 13, "moments");
  EXPECT_EQ(moments.outcome, Outcome::degrades);
  EXPECT_EQ(moments.worst, 0.2);
  EXPECT_EQ(moments.at, 0.95);
  EXPECT_EQ(moments.failed, 2);
  EXPECT_EQ(moments.points, 3);
  EXPECT_EQ(cell_of(report, 13, "bruneton").outcome, Outcome::breaks);
  EXPECT_EQ(cell_of(report, 13, "path").outcome, Outcome::reference);
  EXPECT_EQ(cell_of(report, 12, "moments").points, 0);
}

TEST(Stability, TheTableAndThePictureSayIt) {
  std::string table = stability_table(some_findings()),
              picture = stability_svg(some_findings());
  EXPECT_NE(table.find(
                "| 13 | Forward peaks | 2 % |  |  |  | **breaks at 0.95** | **20 % at 0.95** | "
                "reference |  |"),
            std::string::npos)
      << table;
  EXPECT_NE(picture.find("20 % at 0.95"), std::string::npos);
  EXPECT_NE(picture.find("a device"), std::string::npos);
}

StabilityReport noisy_findings() {
  StabilityReport report{"a device", "1.0", {}};
  for (double noise : {0.01, 0.08, 0.03})
    report.points.push_back({.row = 13, .method = "path", .trigger = 0.9, .noise = noise});
  report.points.push_back(
      {.row = 14, .method = "auto", .trigger = 0.9, .noise = 0.08, .stated = 0.05});
  return report;
}

TEST(Stability, ACellThatChanceMayHideSaysHowMuchAndNotThatItHolds) {
  EXPECT_EQ(cell_of(noisy_findings(), 13, "path").noise, 0.08);
  EXPECT_EQ(cell_of(noisy_findings(), 14, "auto").noise, 0) << "twice what it states";
  EXPECT_NE(stability_table(noisy_findings()).find("| noise 8 % |"), std::string::npos);
  const std::string picture = stability_svg(noisy_findings()), holds = "<rect class=\"holds\"";
  EXPECT_NE(picture.find(">noise 8 %<"), std::string::npos);
  ASSERT_NE(picture.find(holds), std::string::npos);
  EXPECT_EQ(picture.find(holds), picture.rfind(holds)) << "that of row 14 alone";
}

/// A row that is measured as it is told, not by the method.
StabilityPoint judged(const std::vector<Measured>& found) {
  StabilityRow row;
  row.number = 13;
  row.bound = 0.02;
  row.stated_errors = 2;
  row.measure = [&](Trial&, double) { return found; };
  return measure_point(device(), row, "auto", 0, {});
}

Measured told(double value, double stated) {
  Measured quantity = value;
  quantity.stated = stated;
  return quantity;
}

TEST(Stability, AFailureIsNotExcusedByWhatIsStatedElsewhere) {
  const StabilityPoint excused = judged({told(0.05, 0.03), told(0.01, 0)});
  EXPECT_EQ(excused.outcome, Outcome::holds);
  EXPECT_EQ(excused.value, 0.05);
  const StabilityPoint failed = judged({told(0.01, 0.3), told(0.05, 0.01)});
  EXPECT_EQ(failed.outcome, Outcome::degrades);
  EXPECT_EQ(failed.value, 0.05);
  EXPECT_EQ(failed.stated, 0.01);
  const StabilityPoint smaller = judged({told(0.5, 0.3), told(0.05, 0.01)});
  EXPECT_EQ(smaller.outcome, Outcome::degrades) << "the one that fails, not the larger one";
  EXPECT_EQ(judged({}).outcome, Outcome::reference);
}

TEST(Stability, NoiseAddsInQuadratureAndIsKept) {
  EXPECT_DOUBLE_EQ(together({3, 4}), 5);
  const Measured gap = apart(1, 0.5, 0.2);
  EXPECT_DOUBLE_EQ(gap.value, 0.3);
  EXPECT_DOUBLE_EQ(gap.noise, 0.2);
  EXPECT_EQ(apart(1, 0.9, 0.2).value, 0);
  EXPECT_DOUBLE_EQ(larger(gap, {0.4, 0.01}).noise, 0.2);
  EXPECT_DOUBLE_EQ(larger(gap, {0.4, 0.01}).value, 0.4);
}

TEST(Stability, AHueThatIsOffIsAnErrorAndABrightnessIsNone) {
  const Watch watch;
  Trial asked(device(), "raymarch", {}, 1 << 15, watch);
  const std::vector<Direction> zenith{{90, 0}, {86, 0}, {86, 120}};
  const nlohmann::json scene = changed(plain_scene(), {{"sun", {{"elevation_deg", 10}}}});
  EXPECT_LT(asked.error_of_hue(scene, zenith)->value, 1e-4);
  Trial coarse(device(), "nishita", {}, 1 << 15, watch);
  const Measured hue = *coarse.error_of_hue(scene, zenith),
                 light = *coarse.error(scene, zenith);
  EXPECT_GT(hue.value, 1e-3);
  EXPECT_LT(hue.value, light.value);
}

TEST(Stability, APointIsReadBackAsItWasWritten) {
  StabilityPoint point{.row = 7,
                       .method = "auto",
                       .trigger = -9,
                       .outcome = Outcome::refuses,
                       .value = 0.25,
                       .least = 0.125,
                       .noise = 0.0625,
                       .stated = 0.5,
                       .note = "too many"};
  StabilityPoint again = stability_point_from(point_document(point));
  EXPECT_EQ(point_document(again), point_document(point));
}

}  // namespace
}  // namespace cyanometer
