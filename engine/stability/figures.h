// How the suite's figures read.
#pragma once

#include <string>

#include "engine/stability/report.h"

namespace cyanometer {

/// As a share of a hundred, with two digits that count.
std::string figure(double value);
/// As short as it goes.
std::string number(double value);
/// "0.3 %", "6 % at 12", "refuses".
std::string cell_words(const StabilityCell& cell);

}  // namespace cyanometer
