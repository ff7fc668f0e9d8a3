// The tables, read back to be looked at.
#pragma once

#include <vector>

#include "engine/image/panels.h"
#include "engine/methods/bruneton/tables.h"

namespace cyanometer::bruneton {

/// The source of all orders from the second on, as refined; the diffuse irradiance of the
/// ground; the view, for all altitudes and suns that its table is for; and where the first
/// order comes from a table of each constituent, those. Without orders beyond the first only
/// the last are there. Values are per unit of the sun's irradiance.
std::vector<Panels> table_panels(TableMaker& maker, Tracer& tracer, const UploadedScene& scene,
                                 const Setup& setup);

}  // namespace cyanometer::bruneton
