// Scattering by spheres [Bohren and Huffman 1983, Absorption and Scattering of Light by Small
// Particles, chapter 4 and appendix A].
#pragma once

#include <complex>
#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

/// The scattering coefficients of one sphere; element 0 is a_1.
struct MieSeries {
  double size_parameter = 0;  ///< circumference over wavelength
  std::vector<std::complex<double>> a, b;
};

/// Valid for size parameters above 0 up to at least 10000; `index` is relative to the medium,
/// its imaginary part not negative (absorbing).
MieSeries mie_series(double size_parameter, std::complex<double> index);

/// Cross-sections over the geometric one, and the mean cosine of the scattering angle.
double extinction_efficiency(const MieSeries& series);
double scattering_efficiency(const MieSeries& series);
double asymmetry(const MieSeries& series);

/// (|S_1|^2 + |S_2|^2) / 2 at each cosine of the scattering angle, for unpolarised light. Its
/// integral over the sphere is pi x^2 times the scattering efficiency.
std::vector<double> scattered_intensity(const MieSeries& series,
                                        const std::vector<double>& cosines);

/// A population of spheres at some wavelengths; cross-sections are means over the particles.
struct MieOptics {
  std::vector<double> extinction_um2;  ///< by wavelength
  std::vector<double> scattering_um2;
  std::vector<std::vector<double>> phase;  ///< [wavelength][angle], 1/sr, integrating to 1
};

/// The angles of `MieOptics::phase`, ascending from 0 to pi, dense towards both ends.
const std::vector<double>& mie_angles_rad();

/// Integrates over the log-normal distribution of radii (one size where geometric_sigma is
/// within 0.1 % of 1). Spheres of size parameters beyond 5000 scatter like those of 5000, in
/// proportion to their area. Cross-sections are good to 1e-3. Phase functions are good to 1 %
/// (rms over the angles) up to median size parameters of some 20; of larger ones, clouds, to 4
/// %, what is left being the ripple between the sizes that the bounded time allows. Solved
/// spheres are kept, so that the same refractive index is cheap again; safe from any thread.
/// Looks up between spheres (attention.h).
MieOptics mie_optics(const MieSpheres& spheres, const std::vector<double>& wavelengths_nm);

}  // namespace cyanometer
