// A scene's constituents as curves, to be looked at: computed by the physics that frames are
// made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

struct ConstituentCurves {
  std::string name;
  std::vector<double> density;            ///< by altitude; 1 where the coefficients hold
  std::vector<double> scattering_per_km;  ///< by wavelength, where the density is 1
  std::vector<double> absorption_per_km;
  std::vector<double> optical_depth;  ///< by wavelength, of extinction, from ground to top
  /// [phase wavelength][angle], 1/sr; empty where nothing scatters.
  std::vector<std::vector<double>> phase;
  /// 3.912 over the extinction at the wavelength nearest to 550 nm where the density is 1, km;
  /// none where that is 0.
  std::optional<double> visibility_km;
};

struct Curves {
  std::vector<double> altitude_km;     ///< from the ground to the hard top
  std::vector<double> wavelengths_nm;  ///< the scene's; where it leaves them open, the visible
  std::vector<double> angle_deg;       ///< 0, forward, to 180; denser towards 0
  /// Those of the wavelengths that are nearest to 440, 550 and 680 nm.
  std::vector<double> phase_wavelengths_nm;
  std::vector<ConstituentCurves> constituents;  ///< those that scatter or absorb
};

/// On any thread. @throws SceneError where a constituent contradicts itself
Curves constituent_curves(const Scene& scene);

}  // namespace cyanometer
