// Where a quadrature in altitude should be cut.
#pragma once

#include <vector>

#include "engine/problem.h"

namespace cyanometer {

/// Altitudes (km, ascending, inside the shell) at which the density of a constituent jumps or
/// bends so that the optical depth shows it, the corners of tents and the nodes of tables, and
/// at which a dense layer ends for light that passes it; at most a dozen, those that matter
/// most.
std::vector<double> profile_kinks_km(const Problem& problem);

}  // namespace cyanometer
