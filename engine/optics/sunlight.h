// The sun above the air: measured, as a black body, and how its disc darkens towards the edge.
#pragma once

namespace cyanometer {

/// Spectral irradiance at 1 au, W m^-2 nm^-1, from 10 to 5000 nm [ASTM E490-00a (2006), zero
/// air mass, total 1366.1 W m^-2]. Averaged over hats of 10 nm below 200 nm, 5 nm to 1000 nm,
/// 50 nm to 2000 nm and 200 nm beyond, so that one wavelength stands for its neighbourhood and
/// no Fraunhofer line tints a picture of three wavelengths; the averaging keeps the energy. The
/// standard begins at 119.5 nm: below 110 nm this is 1e-5, the order of the quiet sun's extreme
/// ultraviolet.
double measured_sunlight(double wavelength_nm);

/// Planck's spectral radiance, W m^-2 sr^-1 nm^-1.
double planck(double temperature_k, double wavelength_nm);

/// Spectral irradiance, W m^-2 nm^-1, of a black body of the sun's size at the sun's distance:
/// in total 1361 W m^-2 at 5772 K [IAU 2015 Resolution B3], and (T / 5772 K)^4 times that at T.
double blackbody_sunlight(double temperature_k, double wavelength_nm);

/// The exponent of the disc's radiance, mu^exponent, mu the cosine of the heliocentric angle:
/// 0.292 um / l - 0.023 [Hestroffer and Magnan 1998, A&A 333, 338], fitted to 416..1099 nm and
/// held at the nearer end outside.
double limb_darkening_exponent(double wavelength_nm);

}  // namespace cyanometer
