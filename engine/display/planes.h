// Which planes a frame consists of, and how each is made from a tile's spectral quantities.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/problem.h"

namespace cyanometer {

/// Up to four planes that are written together: plane k is, summed over wavelengths, rows[k]
/// times the weighted quantities.
struct PlaneGroup {
  std::vector<std::string> channels;        ///< names; the planes beyond them are scratch
  std::array<std::vector<double>, 4> rows;  ///< by wavelength; empty is nothing
  std::array<float, 4> inscatter{}, ground{}, sun{}, transmittance{};  ///< weights by plane
  bool stars = false;
};

/// The first group is always R, G, B and a plane without a name: the luminance that exposure is
/// taken from, without the sun and stars, -1 where a ray meets neither air nor ground. What the
/// file holds follows in the others where it is more or other than R, G, B.
std::vector<PlaneGroup> plane_groups(const Scene& scene, const Problem& problem,
                                     const Output& output);

}  // namespace cyanometer
