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

TEST(Stability, APointIsReadBackAsItWasWritten) {
  StabilityPoint point{.row = 7,
                       .method = "auto",
                       .trigger = -9,
                       .outcome = Outcome::refuses,
                       .value = 0.25,
                       .least = 0.125,
                       .stated = 0.5,
                       .note = "too many"};
  StabilityPoint again = stability_point_from(point_document(point));
  EXPECT_EQ(point_document(again), point_document(point));
}

}  // namespace
}  // namespace cyanometer
