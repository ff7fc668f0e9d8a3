#include "engine/stability/suite.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

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

/// Each by what was stated for itself; where chance may explain all, by what was seen.
auto nearer_to_its_bound(const StabilityRow& row) {
  return [&row](const Measured& a, const Measured& b) {
    const double of_a = row.allowed(a.stated), of_b = row.allowed(b.stated);
    return std::pair(a.least * of_b, a.value * of_b) <
           std::pair(b.least * of_a, b.value * of_a);
  };
}

void measure(const StabilityRow& row, Trial& trial, StabilityPoint& point) {
  if (row.many_orders && trial.first_order_only()) {
    point.outcome = Outcome::left_out;
    return;
  }
  const std::vector<Measured> found = row.measure(trial, point.trigger);
  if (found.empty()) {
    point.outcome = Outcome::reference;
    return;
  }
  const Measured& worst = *std::ranges::max_element(found, nearer_to_its_bound(row));
  point.value = worst.value;
  point.least = worst.least;
  point.stated = worst.stated;
  point.noise = std::ranges::max(found, {}, &Measured::noise).noise;
  if (row.number > 0 && !(worst.least <= row.allowed(worst.stated)))
    point.outcome = Outcome::degrades;
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
          {"noise", point.noise},     {"stated", point.stated},
          {"note", point.note}};
}

StabilityPoint stability_point_from(const json& document) {
  return {.row = document.at("row"),
          .method = document.at("method"),
          .trigger = document.at("trigger"),
          .outcome = outcome_named(document.at("outcome")),
          .value = document.at("value"),
          .least = document.at("least"),
          .noise = document.at("noise"),
          .stated = document.at("stated"),
          .note = document.at("note")};
}

}  // namespace cyanometer
