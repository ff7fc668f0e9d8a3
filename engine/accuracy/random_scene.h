// Seeded random atmospheres over what the scene document can say, for trials of methods and
// plans.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace cyanometer {

/// A scene document; the same for the same seed on every machine. Planets of 300 to 60000 km
/// with a top at 0.5 to 30 % of the radius; air, haze and an absorber, each present or not, up
/// to vertical optical depths of 3, 10 and 1; asymmetries from -0.3 to 0.95; grounds from black
/// to 0.9; suns from the zenith to 12 deg below the horizon; cameras on the ground, in the air
/// and out to twenty radii, all looking at something. Three wavelengths,
/// frames of 128 to 1280 columns.
nlohmann::json random_scene(std::uint64_t seed);

}  // namespace cyanometer
