// Colour: the CIE 1931 standard observer, Rec. 709, chromatic adaptation.
#pragma once

#include <array>
#include <vector>

namespace cyanometer {

using Triple = std::array<double, 3>;
using Matrix = std::array<double, 9>;  ///< row-major

/// The colour matching functions x, y, z of the CIE 1931 2 degree standard observer: linear in
/// the standard's table of 5 nm from 360 to 830 nm [CIE 015:2018, table T.4], 0 outside.
Triple colour_matching(double wavelength_nm);

inline constexpr double shortest_visible_nm = 360, longest_visible_nm = 830;
/// Lumens per watt at the peak of photopic vision [SI; CIE 015:2018].
inline constexpr double luminous_efficacy = 683;

/// Linear Rec. 709 primaries with white D65 [ITU-R BT.709-6], from their chromaticities.
const Matrix& rec709_from_xyz();
const Matrix& xyz_from_rec709();

Triple operator*(const Matrix& m, const Triple& v);
Matrix operator*(const Matrix& a, const Matrix& b);
Matrix inverse(const Matrix& m);

/// Bradford's adaptation, from colours seen under `white` to the same colours seen under D65,
/// linear Rec. 709 to linear Rec. 709 [Lam 1985; ICC.1:2022 annex E].
/// @throws std::domain_error where `white` has a cone response that is not positive
Matrix adaptation_to_d65(const Triple& white_xyz);

/// A set of `count` wavelengths (3 to 64, nm, ascending) from which colours under skies are
/// interpolated best. Measured errors stand in colour.cpp.
std::vector<double> colour_wavelengths(int count);

}  // namespace cyanometer
