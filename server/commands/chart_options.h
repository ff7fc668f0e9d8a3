// What chart and bench can be told alike.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/accuracy/chart.h"

namespace cyanometer {

/// @param settings  defaults; outlives the command
void add_chart_options(CLI::App& command, ChartSettings& settings);

}  // namespace cyanometer
