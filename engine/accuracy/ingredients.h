// What each ingredient of a scene is worth: the error of leaving it out, and the time that this
// saves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

struct Worth {
  std::string name;
  double error = 0;  ///< the contract's, of the scene without it against the scene with it
  /// 99th percentile of colour differences as displayed, with the whole scene's exposure; none
  /// where no ray meets air or ground.
  std::optional<double> ciede2000;
  double ms_saved = 0;  ///< planned device time with it less that without it; may be negative
};

/// Every ingredient, by
/// - the name of a constituent; after "constituent." where it is one of those below;
/// - "multiple_scattering": single scattering alone against all orders that are asked for;
/// - "order_2", "order_3", ...: one order less against so many, up to the first that is worth
///   less than 0.1 %, and to 6;
/// - "curvature": the air lies flat, its altitudes kept;
/// - "ground": it neither reflects nor mirrors; a map's heights go with it;
/// - "wavelength_4", ...: colour from one wavelength less against from so many, up to as many
/// as
///   `auto` takes; of given wavelengths that become a colour, the one at that place, from 1, is
///   left out, where time saved is that of having one less, whichever.
/// Errors are of stratified rays, by the finest solution without random numbers; times are of
/// the plans that `auto` makes. The scene's own method does not matter.
/// @throws OverLimit, Cancelled, DeviceLost
std::vector<Worth> explain(Engine& engine, const Scene& scene, const Watch& watch = {});

}  // namespace cyanometer
