// Scattering by molecules.
#pragma once

#include <string_view>

namespace cyanometer {

/// Refractive index of a named gas ("air", "co2", "n2", "h2", "he", "ch4") at 101325 Pa and
/// 288.15 K. Outside the range of a gas's formula (gas.cpp) the index at the nearer end is
/// held: the scattering still goes as l^-4, what is lost is the rest of the dispersion.
/// @throws std::out_of_range for another name
double refractive_index(std::string_view gas, double wavelength_nm);

/// The King correction factor F = (6 + 3 rho) / (6 - 7 rho) of a named gas, held like the
/// index.
/// @throws std::out_of_range for another name
double king_factor(std::string_view gas, double wavelength_nm);

/// Scattering by molecules of refractive index `index` (at 101325 Pa and 288.15 K), per km:
/// 24 pi^3 / l^4 ((n^2 - 1) / (n^2 + 2))^2 F / N_s^2 p / (k T) [Bucholtz 1995, Appl. Opt. 34,
/// 2765, eq. 4, and the ideal gas]. Pressure 0 gives 0.
double molecular_scattering_per_km(double index, double king, double pressure_pa,
                                   double temperature_k, double wavelength_nm);

/// Chandrasekhar's gamma = rho / (2 - rho) of the Rayleigh phase function [Bucholtz 1995, eq.
/// 13], rho = 6 (F - 1) / (3 + 7 F).
double depolarisation_gamma(double king);

}  // namespace cyanometer
