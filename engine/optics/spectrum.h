// Spectra of the scene document as functions of wavelength.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

/// The value of `spectrum` at `wavelength_nm`. An array's values belong to
/// `scene_wavelengths_nm` (ascending or descending): linear between them, constant beyond,
/// exact at each.
double evaluate(const Spectrum& spectrum, const std::vector<double>& scene_wavelengths_nm,
                double wavelength_nm);

/// The same at many wavelengths.
std::vector<double> evaluate(const Spectrum& spectrum,
                             const std::vector<double>& scene_wavelengths_nm,
                             const std::vector<double>& wavelengths_nm);

/// The sun's spectral irradiance at the planet, W m^-2 nm^-1 (or the unit of the scene's own
/// numbers, which are those at the planet).
double sunlight(const Sun& sun, const std::vector<double>& scene_wavelengths_nm,
                double wavelength_nm);

}  // namespace cyanometer
