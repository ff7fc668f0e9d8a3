// The findings as a table.
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "engine/stability/figures.h"

namespace cyanometer {
namespace {

std::string sweep_of(const StabilityRow& row) {
  std::string all;
  for (double value : row.sweep) all += (all.empty() ? "" : ", ") + number(value);
  return all;
}

/// Numbers of the rows whose quantity holds the error that `auto` states so often.
std::string rows_that_hold(int stated_errors) {
  std::string all;
  for (const StabilityRow& row : stability_rows()) {
    if (row.stated_errors == stated_errors)
      all += (all.empty() ? "" : ", ") + std::to_string(row.number);
  }
  return all;
}

void head(std::ostream& table, const char* first) {
  table << first;
  for (const std::string& method : stability_subjects()) table << " `" << method << "` |";
  table << "\n|---|---|---|";
  for (std::size_t i = 0; i < stability_subjects().size(); ++i) table << "---|";
  table << "\n";
}

/// Errors along quantities of a scene, a value of it a line.
void write_curves(std::ostream& table, const StabilityReport& report) {
  head(table, "\n| errors along | | |");
  for (const StabilityRow& curve : stability_curves()) {
    for (double trigger : curve.sweep) {
      table << "| " << (trigger == curve.sweep.front() ? curve.trigger : "") << " | "
            << number(trigger) << " | |";
      for (const std::string& method : stability_subjects()) {
        const auto found =
            std::ranges::find_if(report.points, [&](const StabilityPoint& point) {
              return point.row == 0 && point.note == curve.name && point.method == method &&
                     point.trigger == trigger;
            });
        const bool measured = found != report.points.end() && found->outcome == Outcome::holds;
        table << " " << (measured ? figure(found->value) : "") << " |";
      }
      table << "\n";
    }
  }
}

}  // namespace

std::string figure(double value) {
  if (!(value > 0)) return "0";
  if (value < 1e-6) return "< 0.0001 %";
  char text[32];
  std::snprintf(text, sizeof text, value >= 1 ? "%.0f %%" : "%.2g %%", 100 * value);
  return text;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string cell_words(const StabilityCell& cell) {
  switch (cell.outcome) {
    case Outcome::holds:
      if (cell.points == 0) return "";
      return cell.noise > 0 ? "noise " + figure(cell.noise) : figure(cell.worst);
    case Outcome::degrades:
      return figure(cell.worst) + " at " + number(cell.at);
    case Outcome::breaks:
      return "breaks at " + number(cell.at);
    case Outcome::refuses:
      return "refuses";
    case Outcome::left_out:
      return "leaves out";
    case Outcome::reference:
      return "reference";
  }
  return "";
}

bool tells_nothing(const StabilityPoint& point) {
  if (point.row == 0 || point.outcome != Outcome::holds) return false;
  const StabilityRow& row = stability_rows().at(static_cast<std::size_t>(point.row - 1));
  return point.noise > row.allowed(point.stated);
}

StabilityCell cell_of(const StabilityReport& report, int row, const std::string& method) {
  StabilityCell cell;
  auto rank = [](Outcome outcome) {
    switch (outcome) {
      case Outcome::breaks:
        return 5;
      case Outcome::degrades:
        return 4;
      case Outcome::holds:
        return 3;
      case Outcome::refuses:
        return 2;
      default:
        return 1;
    }
  };
  for (const StabilityPoint& point : report.points) {
    if (point.row != row || point.method != method) continue;
    bool worse = cell.points == 0 || rank(point.outcome) > rank(cell.outcome) ||
                 (point.outcome == cell.outcome && point.value > cell.worst);
    ++cell.points;
    if (tells_nothing(point)) cell.noise = std::max(cell.noise, point.noise);
    cell.failed += point.outcome == Outcome::degrades || point.outcome == Outcome::breaks;
    if (!worse) continue;
    cell.outcome = point.outcome;
    cell.worst = point.value;
    cell.at = point.trigger;
    cell.note = point.note;
  }
  return cell;
}

std::string stability_table(const StabilityReport& report) {
  std::ostringstream table;
  table << "Measured by `cyanometer stability`, version " << report.version << ", on "
        << report.device << R"(.

A cell is the largest value of the row's quantity, which stands in the second table with what it is
swept over. It is **bold** where it is over the row's bound by more than the noise of its reference,
and then says at which value of the sweep it is largest; the method's limits, in `/v1/methods`, say so
too. `noise` stands where chance may hide more than the bound, and nothing is shown. For `auto` the
bound is the error that it states, as often as the quantity holds it, where that is larger: once in
rows )" << rows_that_hold(1)
        << ", twice in " << rows_that_hold(2) << ", three times in " << rows_that_hold(3)
        << R"(. `leaves out` is said of a
row about orders of scattering that the method does not compute, `reference` of the method that the
others are measured against; an error that is measured is one of the orders that the method computes.

)";
  head(table, "| | row | bound |");
  for (const StabilityRow& row : stability_rows()) {
    table << "| " << row.number << " | " << row.name << " | "
          << (row.bound > 0 ? figure(row.bound) : "none") << " |";
    for (const std::string& method : stability_subjects()) {
      StabilityCell cell = cell_of(report, row.number, method);
      const char* strong = cell.failed > 0 ? "**" : "";
      table << " " << strong << cell_words(cell) << strong << " |";
    }
    table << "\n";
  }
  table << "\n| | measured | over |\n|---|---|---|\n";
  for (const StabilityRow& row : stability_rows()) {
    table << "| " << row.number << " | " << row.quantity << " | " << row.trigger << ": "
          << sweep_of(row) << " |\n";
  }
  write_curves(table, report);
  return table.str();
}

}  // namespace cyanometer
