// Legendre coefficients of phase functions: chi_l = 2 pi times the integral of p(mu) P_l(mu)
// over mu, so that p(mu) = sum over l of (2 l + 1) / (4 pi) chi_l P_l(mu), chi_0 = 1.
#pragma once

#include <vector>

namespace cyanometer {

/// Of Rayleigh scattering with depolarisation [Bucholtz 1995, eq. 12]: 1, 0, and 1/10 where
/// gamma is 0.
std::vector<double> rayleigh_coefficients(double gamma, int degree);
/// g^l [Henyey and Greenstein 1941].
std::vector<double> henyey_greenstein_coefficients(double g, int degree);
/// In closed form: [Cornette and Shanks 1992, eq. 8] is Henyey and Greenstein's function times
/// 3 (1 + mu^2) / (2 (2 + g^2)), and mu^2 P_l is a sum of three Legendre polynomials.
std::vector<double> cornette_shanks_coefficients(double g, int degree);
/// Of tables of several functions of the same angles, as they are interpolated (phase.h), by
/// quadrature between their nodes. @param values [function][angle] @returns [function][l]
std::vector<std::vector<double>> tabulated_coefficients(
    const std::vector<double>& angle_rad, const std::vector<std::vector<double>>& values,
    int degree);

/// The function that has those coefficients, over an isotropic one's: the sum over l of (2 l +
/// 1) chi_l P_l(cosine).
double legendre_sum(const std::vector<double>& chi, double cosine);

}  // namespace cyanometer
