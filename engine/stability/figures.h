// How the suite's figures read.
#pragma once

#include <string>

#include "engine/stability/report.h"

namespace cyanometer {

/// As a share of a hundred, with two digits that count.
std::string figure(double value);
/// As short as it goes.
std::string number(double value);
/// Whether chance may hide more than what is allowed, though the point holds.
bool tells_nothing(const StabilityPoint& point);
/// "0.3 %", "6 % at 12", "noise 8 %" where that hides more than the bound, "refuses".
std::string cell_words(const StabilityCell& cell);

}  // namespace cyanometer
