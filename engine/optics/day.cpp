#include "engine/optics/day.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace cyanometer {
namespace {

constexpr int day_s = 24 * 3600, step_s = 600;
constexpr double civil_twilight_deg = -6;

struct Place {
  double latitude_deg, longitude_deg;
  std::string date, offset;

  /// At so many seconds after midnight; the day's end is its last second.
  std::string time(int second) const {
    const int s = std::min(second, day_s - 1);
    char clock[32];
    std::snprintf(clock, sizeof clock, "T%02d:%02d:%02d", s / 3600, s / 60 % 60, s % 60);
    return date + clock + offset;
  }
  DayMoment at(int second) const {
    const std::string when = time(second);
    return {when, sun_position(latitude_deg, longitude_deg, when)};
  }
};

std::string offset_text(int minutes) {
  char text[32];
  std::snprintf(text, sizeof text, "%c%02d:%02d", minutes < 0 ? '-' : '+',
                std::abs(minutes) / 60 % 100, std::abs(minutes) % 60);
  return text;
}

/// When the sun first passes the elevation upwards, or last downwards.
std::optional<std::string> passing(const Place& place, const std::vector<DayMoment>& moments,
                                   double elevation_deg, bool upwards) {
  const auto above = [&](const DayMoment& moment) {
    return (moment.sun.elevation_deg > elevation_deg) == upwards;
  };
  std::optional<int> found;
  for (std::size_t i = 1; i < moments.size(); ++i) {
    if (above(moments[i - 1]) || !above(moments[i])) continue;
    if (!found || !upwards) found = static_cast<int>(i) * step_s;
  }
  if (!found) return std::nullopt;
  int low = *found - step_s, high = *found;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (above(place.at(middle)) ? high : low) = middle;
  }
  return place.time(high);
}

}  // namespace

SunDay sun_day(double latitude_deg, double longitude_deg, const std::string& date,
               int utc_offset_min) {
  const Place place{latitude_deg, longitude_deg, date, offset_text(utc_offset_min)};
  SunDay day;
  for (int second = 0; second <= day_s; second += step_s) {
    day.moments.push_back(place.at(second));
  }
  day.highest = *std::ranges::max_element(
      day.moments, {}, [](const DayMoment& moment) { return moment.sun.elevation_deg; });
  day.dawn = passing(place, day.moments, civil_twilight_deg, true);
  day.sunrise = passing(place, day.moments, 0, true);
  day.sunset = passing(place, day.moments, 0, false);
  day.dusk = passing(place, day.moments, civil_twilight_deg, false);
  return day;
}

}  // namespace cyanometer
