// Reflectance spectra from colours.
#pragma once

#include <array>

namespace cyanometer {

/// What linear Rec. 709 red, green and blue of 1 each contribute at a wavelength [Mallett and
/// Yuksel 2019, Spectral Primary Decomposition for Rendering with sRGB Reflectance]. The three
/// add up to 1 and none is negative, so a reflectance stays between 0 and 1 as its colour does;
/// under D65 it looks as that colour. Theirs from 380 to 780 nm, constant beyond.
std::array<double, 3> reflectance_basis(double wavelength_nm);

}  // namespace cyanometer
