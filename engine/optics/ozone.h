// Ozone's absorption.
#pragma once

namespace cyanometer {

/// Molecules per square metre in one Dobson unit, as the scene document defines it.
inline constexpr double molecules_per_dobson_unit = 2.687e20;

/// Absorption cross-section of an ozone molecule at stratospheric temperature (218 to 233 K),
/// m^2, averaged over bins of 1 to 10 nm: the bands of Hartley (to 310 nm), Huggins (to 360 nm)
/// and Chappuis (to 850 nm). Sources in ozone.cpp. Below 175 nm, where no table is held, that
/// of 176 nm (true cross-sections there lie between 1e-22 and 2e-21 m^2); 0 from 850 nm, where
/// 300 Dobson units are less than 1e-3 of optical depth.
double ozone_cross_section_m2(double wavelength_nm);

}  // namespace cyanometer
