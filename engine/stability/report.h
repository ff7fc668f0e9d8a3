// The suite's findings for people: as a table and as a picture.
#pragma once

#include <string>
#include <vector>

#include "engine/stability/suite.h"

namespace cyanometer {

struct StabilityReport {
  std::string device, version;
  std::vector<StabilityPoint> points;  ///< those of curves have row 0 and, as `note`, its name
};

/// A row's points of one method, as one word or figure.
struct StabilityCell {
  Outcome outcome = Outcome::holds;  ///< the worst of them
  double worst = 0, at = 0;          ///< the largest value, and the trigger where it is
  int points = 0, failed = 0;        ///< all of them, and those that degrade or break
  /// The largest noise of those that hold, where it is more than the bound: chance may hide
  /// that they do not. 0: nowhere.
  double noise = 0;
  std::string note;  ///< of the worst
};
StabilityCell cell_of(const StabilityReport& report, int row, const std::string& method);

/// Method by row in Markdown, and below it what each row measures.
std::string stability_table(const StabilityReport& report);

/// One self-contained SVG, light or dark as its reader's screen is: method by row, each cell
/// with the quantity over its bound along the trigger; below, errors along the curves.
std::string stability_svg(const StabilityReport& report);

}  // namespace cyanometer
