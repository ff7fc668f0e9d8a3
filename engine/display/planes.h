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
  /// Of a composite: what of the client's picture is added, and whether the group holds the
  /// transmittance along its rays.
  bool objects = false, background = false, transmittance_itself = false;
};

/// The first group is always R, G, B and a plane without a name: the luminance that exposure is
/// taken from, without the sun and stars, -1 where a ray meets neither air nor ground. What the
/// file holds follows in the others where it is more or other than R, G, B.
std::vector<PlaneGroup> plane_groups(const Scene& scene, const Problem& problem,
                                     const Output& output);

/// The same for a composite: the client's objects are in the frame and in the layer `ground`,
/// its background is in the frame and in the layer `sun`.
std::vector<PlaneGroup> composite_groups(const Scene& scene, const Problem& problem,
                                         const Output& output);

/// Wavelengths that hold the transmittance of a channel to 1e-3 (tests/composite).
inline constexpr int transmittance_wavelengths = 24;
std::vector<double> wavelengths_of_transmittance(const Scene& scene);

/// By channel R, G, B and wavelength: transmittance in a channel is that of the sun's own
/// light; of even light where the sun has nearly none of the channel's colour, or less than
/// none.
std::array<std::vector<double>, 3> transmittance_rows(
    const Scene& scene, const std::vector<double>& wavelengths_nm);

}  // namespace cyanometer
