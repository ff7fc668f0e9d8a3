// Where the moment tables have their nodes.
#pragma once

#include "engine/physics/physics.h"
#include "engine/problem.h"

namespace cyanometer {

/// Nodes that suit the scene's air: dense where it scatters, and about the edge of its planet's
/// shadow.
template <class Real>
typename physics::Physics<Real>::MomentGrid moment_grid(const Problem& problem, int altitudes,
                                                        int suns);

/// A degree for moments that leaves little of the scene's forward peaks to the aureole's
/// channel: 2 without particles, where that is all, 4 in clear air, up to 8.
int degree_for(const Problem& problem);

}  // namespace cyanometer
