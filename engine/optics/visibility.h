// How far one sees through air that is evenly dense.
#pragma once

namespace cyanometer {

/// A visibility is an extinction at this wavelength.
inline constexpr double visibility_at_nm = 550;
/// ln 50: Koschmieder's range at which a black object's contrast is 2 %.
inline constexpr double visibility_optical_depth = 3.912;

}  // namespace cyanometer
