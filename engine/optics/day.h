// A day of the sun over a place on the Earth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/optics/sun_position.h"

namespace cyanometer {

struct DayMoment {
  std::string time;  ///< RFC 3339, to the second
  SunPosition sun;
};

/// Times at which the disc's centre passes an elevation, unrefracted; none where it does not on
/// that day: at high latitudes, or where the day, as the clock counts it, begins above it.
struct SunDay {
  std::optional<std::string> dawn, sunrise, sunset, dusk;  ///< at -6, 0, 0 and -6 deg
  DayMoment highest;
  std::vector<DayMoment> moments;  ///< from midnight to midnight, every ten minutes
};

/// @param date            as 2026-06-21
/// @param utc_offset_min  of the clock that the day and its times are told by, -1439 to 1439
/// @throws std::invalid_argument as `sun_position`
SunDay sun_day(double latitude_deg, double longitude_deg, const std::string& date,
               int utc_offset_min);

}  // namespace cyanometer
