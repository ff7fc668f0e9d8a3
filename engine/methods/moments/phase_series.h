// The phase functions of a problem as the moment tables use them: Legendre coefficients, the
// share of a forward peak that counts as not scattered, and the aureole that the moments leave
// out.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/problem.h"

namespace cyanometer {

struct PhaseSeries {
  bool particles = false;  ///< whether any function has odd terms
  /// By constituent in the device's order: the share of its extinction that counts as a peak
  /// which goes straight on.
  std::vector<double> straight_on;
  /// As shaders/methods/moments_device.glsl and moments_view.glsl lay it out.
  std::vector<glm::vec4> values;
};

/// Whether the medium scatters, and not as molecules do, whose functions end with P_2.
bool is_particle(const Medium& medium);

/// Legendre coefficients chi_0 to chi_degree at each of the problem's wavelengths.
/// @returns [wavelength][l]
std::vector<std::vector<double>> legendre_coefficients(const PhaseFunction& phase,
                                                       std::size_t wavelengths, int degree);

/// @param degree  of the moments, L
/// @param peaks   whether of chi_(L+1) half counts as a peak that goes straight on, of a narrow
/// peak's nearly all [Wiscombe 1977 has all of it: right for fluxes, for wide peaks too much
/// for light from the horizon]
PhaseSeries make_phase_series(const Problem& problem, int degree, bool peaks);

}  // namespace cyanometer
