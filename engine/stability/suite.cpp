#include "engine/stability/suite.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<Outcome, const char*>, 6> outcome_names{
    {{Outcome::holds, "holds"},
     {Outcome::degrades, "degrades"},
     {Outcome::breaks, "breaks"},
     {Outcome::refuses, "refuses"},
     {Outcome::left_out, "left_out"},
     {Outcome::reference, "reference"}}};

Outcome outcome_named(const std::string& name) {
  for (const auto& [outcome, word] : outcome_names) {
    if (name == word) return outcome;
  }
  throw std::invalid_argument(name + " is no outcome");
}

void measure(const StabilityRow& row, Trial& trial, StabilityPoint& point) {
  if (row.many_orders && trial.first_order_only()) {
    point.outcome = Outcome::left_out;
    return;
  }
  std::optional<Measured> measured = row.measure(trial, point.trigger);
  point.stated = trial.stated();
  if (!measured) {
    point.outcome = Outcome::reference;
    return;
  }
  point.value = measured->value;
  point.least = measured->least;
  // What `auto` says itself is no failure.
  double bound = std::max(row.bound, row.stated_errors * point.stated);
  if (row.number > 0 && !(point.least <= bound)) point.outcome = Outcome::degrades;
}

}  // namespace

std::string name_of(Outcome outcome) {
  return std::ranges::find(outcome_names, outcome, &std::pair<Outcome, const char*>::first)
      ->second;
}

std::vector<std::string> stability_subjects() {
  std::vector<std::string> all;
  for (const MethodDescription& method : methods()) all.push_back(method.name);
  all.push_back("auto");
  return all;
}

StabilityPoint measure_point(Engine& engine, const StabilityRow& row, const std::string& method,
                             double trigger, const StabilitySettings& settings,
                             const Watch& watch) {
  StabilityPoint point{.row = row.number, .method = method, .trigger = trigger};
  Trial trial(engine, method, settings.references, settings.most_work, watch);
  try {
    measure(row, trial, point);
  } catch (const BrokenFrame& frame) {
    point.outcome = Outcome::breaks;
    point.note = frame.what();
  } catch (const OverLimit& limit) {
    point.outcome = Outcome::refuses;
    point.note = limit.what();
  } catch (const SceneError& error) {
    point.outcome = Outcome::refuses;
    point.note = error.what();
  }
  return point;
}

json point_document(const StabilityPoint& point) {
  return {{"row", point.row},         {"method", point.method},
          {"trigger", point.trigger}, {"outcome", name_of(point.outcome)},
          {"value", point.value},     {"least", point.least},
          {"stated", point.stated},   {"note", point.note}};
}

StabilityPoint stability_point_from(const json& document) {
  return {.row = document.at("row"),
          .method = document.at("method"),
          .trigger = document.at("trigger"),
          .outcome = outcome_named(document.at("outcome")),
          .value = document.at("value"),
          .least = document.at("least"),
          .stated = document.at("stated"),
          .note = document.at("note")};
}

}  // namespace cyanometer
