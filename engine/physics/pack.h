// A problem in the device's layout: constituents ordered by the type of their profile,
// wavelengths in groups of four (the rest of the last group filled with nothing), angles as
// sines and tangents.
#pragma once

#include <vector>

#include "engine/physics/physics.h"
#include "engine/problem.h"

namespace cyanometer {

using physics::Physics;

/// Real is float for the device, double for the oracle.
/// The rays are the camera's pixels; `set_directions` replaces them.
template <class Real>
Physics<Real> pack(const Problem& problem);

/// A problem's constituents in the order in which they are packed.
std::vector<const Medium*> packed_media(const Problem& problem);

/// Rays in these directions (unit; x east, y north, z up at the foot point) instead of the
/// camera's.
template <class Real>
void set_directions(Physics<Real>& physics, const std::vector<glm::dvec3>& directions);

/// The constants of a method's pipeline, by constant_id (shaders/device.glsl).
std::vector<std::uint32_t> specialization(const Physics<float>& physics);

}  // namespace cyanometer
