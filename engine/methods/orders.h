// How many orders of scattering a scene takes.
#pragma once

#include "engine/problem.h"

namespace cyanometer {

/// The largest optical depth of scattering over wavelengths, less half of what goes on forward:
/// light takes so many orders to get through for each of it.
double scattering_depth(const Problem& problem);

/// About how bright an order is at the most for the one before: what a layer and the ground
/// under it send back to each other.
double order_ratio(const Problem& problem);

/// Orders after which each is the same share of the one before, so that a geometric series
/// closes the sum.
int orders_until_geometric(const Problem& problem);

}  // namespace cyanometer
