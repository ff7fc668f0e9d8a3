// Seeded random scenes over everything that a scene document can say.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace cyanometer {

/// So many neighbouring seeds share a form (members, variants, lengths of lists) and differ in
/// their numbers, for a device compiles its kernels for a form.
constexpr std::uint64_t scenes_of_a_form = 50;

/// A document drawn from the JSON Schema of scenes: any of its members, each in any of its
/// variants, numbers from the whole range or from that of the page's slider, now and then one
/// of its ends; what the whole does not allow is left out again. The same for the same seed on
/// every machine. It names no method, but may say how many orders; and no size.
nlohmann::json any_scene(std::uint64_t seed);

}  // namespace cyanometer
