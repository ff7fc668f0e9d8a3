#include "engine/accuracy/audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/accuracy/random_scene.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

TEST(RandomScene, IsAValidSceneAndItsSeedsAlone) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    json document = random_scene(seed);
    EXPECT_NO_THROW(read_scene(document)) << document;
    EXPECT_EQ(document, random_scene(seed));
  }
  EXPECT_NE(random_scene(1), random_scene(2));
}

TEST(RandomScene, NeverLooksAtNothing) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    EXPECT_GT(sample_directions(read_scene(random_scene(seed)), 256).size(), 16u) << seed;
  }
}

json choice(const char* method, double ms, double error) {
  return {{"method", method},
          {"options", json::object()},
          {"ms", ms},
          {"error", error},
          {"error_95", {0.9 * error, 1.1 * error}}};
}

/// What a planner did that took `method` for every error and stated `stated`.
json audited(const char* method, double ms, double stated) {
  json scene{{"seed", 1}, {"choices", {choice("cheap", 10, 0.05), choice("dear", 40, 0.005)}}};
  for (double asked : audited_errors) {
    scene["plans"].push_back({{"asked", asked},
                              {"method", method},
                              {"options", json::object()},
                              {"stated", stated},
                              {"met", true},
                              {"ms", ms}});
  }
  return scene;
}

TEST(Audit, CountsWhatWasKeptBoundedAndPaid) {
  // Of 10 % the cheap choice is enough, of 3 and 1 % the dear one, of 0.3 % none.
  std::vector<AuditRow> rows = audit_rows({audited("dear", 40, 0.01)});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].kept, 1);
  EXPECT_EQ(rows[0].time_over_cheapest, 4);
  EXPECT_EQ(rows[1].kept, 1);
  EXPECT_EQ(rows[1].time_over_cheapest, 1);
  EXPECT_EQ(rows[2].kept, 1);
  EXPECT_EQ(rows[3].impossible, 1);
  EXPECT_EQ(rows[3].scenes, 0);
  for (const AuditRow& row : rows) {
    EXPECT_EQ(row.bounded, 1);
    EXPECT_EQ(row.overstated, 2);
  }
}

TEST(Audit, SeesABrokenWord) {
  std::vector<AuditRow> rows = audit_rows({audited("cheap", 10, 0.01)});
  EXPECT_EQ(rows[0].kept, 1);
  EXPECT_EQ(rows[2].kept, 0);
  EXPECT_EQ(rows[2].scenes, 1);
  EXPECT_EQ(rows[2].bounded, 0);
  EXPECT_EQ(rows[2].decided, 1);
}

TEST(Audit, DoesNotDecideWhatTheReferenceCannotTell) {
  std::vector<AuditRow> rows = audit_rows({audited("dear", 40, 0.0051)});
  EXPECT_EQ(rows[0].decided, 0);
  json close = audited("cheap", 10, 0.1);
  close["choices"][0]["error"] = 0.095;
  close["choices"][0]["error_95"] = {0.09, 0.11};
  EXPECT_EQ(audit_rows({close})[0].undecided, std::vector<std::uint64_t>{1});
}

TEST(Audit, TakesARefusalForAMiss) {
  const AuditRow row =
      audit_rows({audited("dear", 40, 0.01), {{"seed", 3}, {"failure", "no"}}})[0];
  EXPECT_EQ(row.scenes, 2);
  EXPECT_EQ(row.kept, 1);
}

/// Of a frame that the planner takes for 10 ms, but that takes 30.
TEST(Audit, CountsTheTimesThatWereKept) {
  json scene = audited("cheap", 10, 0.1);
  scene["choices"][0]["took_ms"] = 30;
  auto plan = [](const char* method, double asked_ms, bool met) {
    return json{
        {"method", method}, {"options", json::object()}, {"asked_ms", asked_ms}, {"met", met}};
  };
  scene["plans_in_time"] = {plan("cheap", 20, true), plan("cheap", 35, true),
                            plan("dear", 50, true), plan("cheap", 5, false),
                            plan("cheap", 31, false)};
  const AuditedTimes times = audited_times({scene, {{"seed", 3}, {"failure", "no"}}});
  EXPECT_EQ(times.promised, 3);
  EXPECT_EQ(times.kept, 2);
  EXPECT_EQ(times.refused, 2);
  EXPECT_EQ(times.possible, 1);
  // What the dear one costs over the cheapest is told by what that took.
  json dear = audited("dear", 40, 0.1);
  dear["choices"][0]["took_ms"] = 30;
  EXPECT_DOUBLE_EQ(audit_rows({dear})[0].time_over_cheapest, 40. / 30);
}

TEST(Audit, OfASceneHasAllChoicesAndPlansAmongThem) {
  testing::TemporaryFolder folder;
  Engine& engine = device();
  json scene = audit_scene(engine, 4, {64, 0.05, 256}, folder.path());
  ASSERT_FALSE(scene.contains("failure")) << scene;
  EXPECT_EQ(scene.at("plans").size(), std::size(audited_errors));
  for (const json& plan : scene.at("plans")) {
    EXPECT_TRUE(std::ranges::any_of(scene.at("choices"), [&](const json& each) {
      return each.at("method") == plan.at("method") && each.at("options") == plan.at("options");
    })) << plan;
  }
  for (const json& plan : scene.at("plans_in_time")) {
    if (plan.at("met")) {
      EXPECT_LT(plan.at("ms"), plan.at("asked_ms"));
    }
  }
  EXPECT_GT(audited_times({scene}).promised, 0);
  EXPECT_THAT(audit_report({scene}), ::testing::HasSubstr("| 10 % |"));
}

}  // namespace
}  // namespace cyanometer
