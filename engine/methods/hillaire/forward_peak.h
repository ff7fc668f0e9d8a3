// The part of the scattering that goes straight on: half of what the mean cosine of a phase
// function says is treated as light that was never scattered, wherever orders two and up are
// concerned.
#pragma once

#include <vector>

#include "engine/physics/pack.h"
#include "engine/problem.h"

namespace cyanometer::hillaire {

/// The same air, of whose scattering `share` times the mean cosine of each phase function is no
/// event any more (delta scaling [Joseph, Wiscombe and Weinman 1976]); absorption stays.
Problem without_forward_peak(const Problem& problem, double share);

/// The scattering of `scaled` over that of `problem`, 1 where nothing scatters: by constituent
/// and group of wavelengths, in the device's order.
std::vector<glm::vec4> scattering_kept(const Problem& problem, const Problem& scaled);

/// The same for scattering from which shares of each constituent's whole extinction were taken,
/// by constituent in the device's order.
std::vector<glm::vec4> scattering_kept(const Problem& problem,
                                       const std::vector<double>& shares_of_extinction);

}  // namespace cyanometer::hillaire
