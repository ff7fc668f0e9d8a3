// The chart as a picture.
#pragma once

#include <string>

#include "engine/accuracy/chart.h"

namespace cyanometer {

/// One self-contained SVG, light or dark as its reader's screen is: a panel a scene, error over
/// the time of a frame, both logarithmic. A point is a setting of a method, with the error's 95
/// % interval and the spread of its times; where tables were made, a thin line leads to the
/// cost of the first frame. The Pareto fronts are those of 1, 10 and many frames an atmosphere;
/// what lies at the edge of the shaded band is below the reference's own noise. Pointing at a
/// point tells its settings.
std::string chart_svg(const Chart& chart);

}  // namespace cyanometer
