#include "engine/accuracy/audit.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "engine/accuracy/dice.h"
#include "engine/accuracy/error.h"
#include "engine/accuracy/random_scene.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Choices that are expected to take longer than this are not timed, ms.
constexpr double longest_timed_ms = 2000;

/// The device time of a whole frame, tables included, once its kernels are compiled.
double timed_ms(Engine& engine, const Scene& scene, const Plan& plan, const Watch& watch) {
  engine.frame_ms(scene, plan, watch);
  return engine.frame_ms(scene, plan, watch);
}

json measure_choice(Engine& engine, const Scene& scene, const Reference& reference,
                    const Plan& plan, const Watch& watch) {
  auto values = engine.radiance(scene, reference.directions, false, plan, watch).relative;
  EstimatedError error = measure_error(values, reference.halves[0], reference.halves[1]);
  json choice{{"method", plan.method},
              {"options", plan.options},
              {"ms", engine.expected_ms(scene, plan)},
              {"error", error.measure.error},
              {"error_95", {error.low, error.high}}};
  if (choice.at("ms") <= longest_timed_ms)
    choice["took_ms"] = timed_ms(engine, scene, plan, watch);
  return choice;
}

json measure_choices(Engine& engine, const Scene& scene, const Reference& reference,
                     const Watch& watch) {
  json choices = json::array();
  for (const MethodDescription& method : methods()) {
    for (const auto& options : method.ladder) {
      Plan plan;
      plan.method = method.name;
      plan.options = options;
      plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
      choices.push_back(measure_choice(engine, scene, reference, plan, watch));
    }
  }
  return choices;
}

json described(const Plan& plan) {
  return {{"method", plan.method},
          {"options", plan.options},
          {"stated", plan.expected_error},
          {"met", plan.met},
          {"ms", plan.expected_ms}};
}

/// What is chosen where only a time is asked, as long as a frame may take.
json plan_in_times(Engine& engine, Scene scene, std::uint64_t seed, const Watch& watch) {
  constexpr int times = 2;
  constexpr double shortest_ms = 20;
  Dice dice(seed);
  scene.method.max_error.reset();
  json plans = json::array();
  for (int i = 0; i < times; ++i) {
    scene.method.max_ms = dice.logarithmic(shortest_ms, longest_timed_ms);
    plans.push_back(described(engine.plan(scene, watch)));
    plans.back()["asked_ms"] = *scene.method.max_ms;
  }
  return plans;
}

const json* choice_of(const json& scene, const json& plan) {
  for (const json& choice : scene.at("choices")) {
    if (choice.at("method") == plan.at("method") &&
        choice.at("options") == plan.at("options")) {
      return &choice;
    }
  }
  return nullptr;
}

/// As it was measured, or as it is expected where it would have been long.
double ms_of(const json& choice) { return choice.value("took_ms", choice.at("ms")); }

/// The time of the cheapest choice that is as good as this.
std::optional<double> cheapest_ms(const json& scene, double error) {
  std::optional<double> ms;
  for (const json& choice : scene.at("choices")) {
    if (choice.at("error") <= error && (!ms || ms_of(choice) < *ms)) ms = ms_of(choice);
  }
  return ms;
}

bool holds(const json& choice, double value) {
  return choice.at("error_95").at(0) <= value && value <= choice.at("error_95").at(1);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

AuditRow row_of(const std::vector<json>& scenes, double asked) {
  AuditRow row;
  row.asked = asked;
  std::vector<double> overstated, over_cheapest;
  for (const json& scene : scenes) {
    // Who gets no frame does not get what was asked.
    row.scenes += scene.contains("failure");
    for (const json& plan : scene.value("plans", json::array())) {
      if (plan.at("asked") != asked) continue;
      const json& choice = *choice_of(scene, plan);
      double error = choice.at("error"), stated = plan.at("stated");
      if (!holds(choice, stated)) {
        ++row.decided;
        row.bounded += error <= stated;
      }
      if (error > 0) overstated.push_back(stated / error);
      std::optional<double> cheapest = cheapest_ms(scene, asked);
      if (!cheapest) {
        ++row.impossible;
      } else if (holds(choice, asked)) {
        row.undecided.push_back(scene.at("seed"));
      } else {
        ++row.scenes;
        if (error > asked) continue;
        ++row.kept;
        over_cheapest.push_back(ms_of(choice) / *cheapest);
      }
    }
  }
  row.overstated = median(overstated);
  row.time_over_cheapest = median(over_cheapest);
  return row;
}

std::string share(int part, int whole) {
  char text[48];
  std::snprintf(text, sizeof text, "%d of %d (%.0f %%)", part, whole,
                whole > 0 ? 100.0 * part / whole : 0.0);
  return text;
}

}  // namespace

json audit_scene(Engine& engine, std::uint64_t seed, const ReferenceGoal& goal,
                 const std::filesystem::path& references, const Watch& watch) {
  json document = random_scene(seed);
  json result{{"seed", seed}};
  try {
    Scene scene = read_scene(document);
    Reference reference = make_reference(engine, scene, goal, references, watch);
    result.update({{"noise", reference.noise}, {"walks", reference.walks}});
    result["plans"] = json::array();
    for (double asked : audited_errors) {
      scene.method.max_error = asked;
      Plan plan = engine.plan(scene, watch);
      result["plans"].push_back(described(plan));
      result["plans"].back()["asked"] = asked;
    }
    result["plans_in_time"] = plan_in_times(engine, scene, seed, watch);
    result["choices"] = measure_choices(engine, scene, reference, watch);
  } catch (const OverLimit& limit) {
    return {{"seed", seed}, {"failure", limit.what()}};
  } catch (const SceneError& error) {
    return {{"seed", seed}, {"failure", error.what()}};
  }
  return result;
}

std::vector<AuditRow> audit_rows(const std::vector<json>& scenes) {
  std::vector<AuditRow> rows;
  for (double asked : audited_errors) rows.push_back(row_of(scenes, asked));
  return rows;
}

AuditedTimes audited_times(const std::vector<json>& scenes) {
  AuditedTimes times;
  for (const json& scene : scenes) {
    for (const json& plan : scene.value("plans_in_time", json::array())) {
      const double asked = plan.at("asked_ms");
      if (plan.at("met")) {
        ++times.promised;
        times.kept += ms_of(*choice_of(scene, plan)) <= asked;
      } else {
        ++times.refused;
        times.possible += cheapest_ms(scene, 1).value_or(asked + 1) <= asked;
      }
    }
  }
  return times;
}

std::string audit_report(const std::vector<json>& scenes) {
  std::ostringstream report;
  report
      << "| asked | kept | undecided | no choice meets it | stated bound holds | stated over "
         "true, median | time over the cheapest, median |\n|---|---|---|---|---|---|---|\n";
  char numbers[64];
  for (const AuditRow& row : audit_rows(scenes)) {
    std::snprintf(numbers, sizeof numbers, "%.2f | %.2f", row.overstated,
                  row.time_over_cheapest);
    report << "| " << 100 * row.asked << " % | " << share(row.kept, row.scenes) << " | "
           << row.undecided.size() << " | " << row.impossible << " | "
           << share(row.bounded, row.decided) << " | " << numbers << " |\n";
  }
  for (const AuditRow& row : audit_rows(scenes)) {
    if (row.undecided.empty()) continue;
    report << "\nUndecided at " << 100 * row.asked << " %, by seed:";
    for (std::uint64_t seed : row.undecided) report << " " << seed;
  }
  const AuditedTimes times = audited_times(scenes);
  report << "\n\nOf times asked, " << share(times.kept, times.promised)
         << " are kept; of those that `auto` says nothing keeps, something does in "
         << share(times.possible, times.refused) << ".\n";
  for (const json& scene : scenes) {
    if (scene.contains("failure")) {
      report << "\nseed " << scene.at("seed") << ": " << scene.at("failure").get<std::string>();
    }
  }
  return report.str();
}

}  // namespace cyanometer
