// The scene as numbers only: what every method computes from. All in double, at the wavelengths
// that are computed; radiance is per unit irradiance of the sun at each of them (1/sr), so that
// the sun's strength and colour enter only at the very end, in `Output`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/surface/ground.h"

namespace cyanometer {

/// Rayleigh scattering with depolarisation [Chandrasekhar 1960; Bucholtz 1995, eq. 12]:
/// 3 / (16 pi (1 + 2 gamma)) ((1 + 3 gamma) + (1 - gamma) cos^2), gamma = rho / (2 - rho).
struct RayleighPhase {
  std::vector<double> gamma;  ///< by wavelength; 0 is 3 / (16 pi) (1 + cos^2)
};
/// Log-linear in angle, normalised to 1 over the sphere at every wavelength.
struct TabulatedPhase {
  std::vector<double> angle_rad;            ///< ascending, 0 to pi
  std::vector<std::vector<double>> values;  ///< [wavelength][angle], 1/sr
};
using PhaseFunction =
    std::variant<RayleighPhase, HenyeyGreenstein, CornetteShanks, TabulatedPhase>;

struct Medium {
  std::string name;
  Profile profile;                        ///< tables already divided by their maximum
  std::vector<double> scattering_per_km;  ///< by wavelength, where the profile is 1
  std::vector<double> absorption_per_km;
  PhaseFunction phase;  ///< idle where nothing scatters
};

struct Problem {
  double planet_radius_km = 0;
  double thickness_km = 0;
  std::vector<double> wavelengths_nm;
  std::vector<double> ground_albedo;  ///< by wavelength; the mean where it is not uniform
  std::optional<Ground> ground;       ///< none where it is the same everywhere
  std::vector<Medium> media;          ///< none that neither scatters nor absorbs

  std::array<double, 3> sun_direction{};  ///< unit; at the foot point: x east, y north, z up
  double sun_distance_km = 0;             ///< from the planet's centre; 0 is parallel light
  double sun_angular_radius_rad = 0;
  int sun_disc_samples = 1;
  double solar_distance_au = 1;  ///< how much brighter stars are beside the sun
  /// The disc's radiance is proportional to (cosine of the heliocentric angle)^exponent, by
  /// wavelength [Hestroffer and Magnan 1998]; 0 is an even disc.
  std::vector<double> limb_darkening_exponent;

  Camera camera;  ///< its altitude is above the sphere, not above what the ground's heights are
  int width = 0, height = 0;
  Show show;
  int scattering_orders = 0;  ///< 0 is the sun and the stars alone; -1 all
};

/// Whether the ground has heights, which end rays in the air.
inline bool has_heights(const Problem& problem) {
  return problem.ground && problem.ground->relief_km > 0;
}

/// The same problem at `count` of its wavelengths, from the one with index `first` on.
Problem at_wavelengths(const Problem& problem, std::size_t first, std::size_t count);

/// How radiance per unit irradiance becomes the channels of an image.
struct Output {
  std::vector<double>
      irradiance;  ///< by wavelength: spectral radiance is this times the result
  /// Linear Rec. 709 (D65) rows: for `cie` in units of white_luminance cd/m^2, for `channels`
  /// in spectral radiance. rgb[c][w] multiplies the result at wavelength w.
  std::array<std::vector<double>, 3> rgb;
  /// XYZ in the same unit, for errors and exposure; for `channels`, the three radiances again.
  std::array<std::vector<double>, 3> xyz;
  double white_luminance = 1000;  ///< cd/m^2 of a `cie` image's 1.0
  double white_card =
      1;  ///< Y (cie) or mean (channels) of a white card facing the sun: exposure 0
  /// Row-major linear Rec. 709 to linear Rec. 709: the display's adaptation to `image.white`.
  std::array<double, 9> white_balance{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// `wavelengths_nm`: those to compute; where the scene names its own, exactly these.
Problem make_problem(const Scene& scene, const std::vector<double>& wavelengths_nm);
Output make_output(const Scene& scene, const std::vector<double>& wavelengths_nm);

/// Vertical optical depth of extinction, at the wavelength where it is largest.
double largest_depth(const Problem& problem);

}  // namespace cyanometer
