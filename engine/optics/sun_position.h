// Where the sun stands in the sky of the Earth, and how far the Earth has turned under the
// stars.
#pragma once

#include <string_view>

namespace cyanometer {

struct SunPosition {
  double elevation_deg = 0;  ///< above the horizontal, unrefracted, of the disc's centre
  double azimuth_deg = 0;    ///< clockwise from north, 0 to 360
};

/// The sun as seen from a point on the ground, without refraction. Within 0.01 deg from 1900 to
/// 2100 (0.004 deg of it because UTC may be 0.9 s away from the Earth's rotation).
/// @param latitude_deg geodetic, north positive
/// @param longitude_deg east positive
/// @param rfc3339 date and time with offset: "2003-10-17T12:30:30-07:00"
/// @throws std::invalid_argument where the time is none, or its year (in UTC) is not 1900 to
/// 2100;
///   what() says what is allowed: "a date and time such as ..."
/// Source: J. Meeus, Astronomical Algorithms, 2nd ed. 1998; the Earth's longitude from the
/// largest terms of VSOP87 (P. Bretagnon and G. Francou, Astron. Astrophys. 202, 309, 1988).
SunPosition sun_position(double latitude_deg, double longitude_deg, std::string_view rfc3339);

/// Mean sidereal time at Greenwich: the right ascension that is in the meridian 0, 0 to 360
/// deg.
/// @throws as `sun_position`
/// Source: Meeus, eq. 12.4.
double sidereal_time_deg(std::string_view rfc3339);

}  // namespace cyanometer
