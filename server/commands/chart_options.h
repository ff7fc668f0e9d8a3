// What chart, bench and attribute can be told alike.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/accuracy/chart.h"

namespace cyanometer {

/// @param goal, folder  defaults; outlive the command
void add_reference_options(CLI::App& command, ReferenceGoal& goal,
                           std::filesystem::path& folder);
/// @param settings  defaults; outlives the command
void add_chart_options(CLI::App& command, ChartSettings& settings);

}  // namespace cyanometer
