#include "engine/optics/sun_position.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cyanometer {
namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr double arcsec = deg / 3600;

// ---- Time

/// Reads RFC 3339 from left to right.
class TimeReader {
 public:
  explicit TimeReader(std::string_view text) : text_(text) {}

  int digits(std::size_t count, int least, int most) {
    if (text_.size() < count) fail();
    int value = 0;
    for (const char c : text_.substr(0, count)) {
      if (c < '0' || c > '9') fail();
      value = 10 * value + (c - '0');
    }
    if (value < least || value > most) fail();
    text_.remove_prefix(count);
    return value;
  }
  /// The next character, which must be one of these.
  char one_of(std::string_view allowed) {
    if (text_.empty() || allowed.find(text_.front()) == std::string_view::npos) fail();
    const char c = text_.front();
    text_.remove_prefix(1);
    return c;
  }
  double fraction() {
    if (text_.empty() || text_.front() != '.') return 0;
    text_.remove_prefix(1);
    double value = digits(1, 0, 9) * 0.1;
    for (double unit = 0.01; !text_.empty() && text_.front() >= '0' && text_.front() <= '9';
         unit *= 0.1)
      value += digits(1, 0, 9) * unit;
    return value;
  }
  void end() const {
    if (!text_.empty()) fail();
  }
  [[noreturn]] static void fail() {
    throw std::invalid_argument(
        "a date and time with its offset from 1900 to 2100, such as 2024-06-20T18:30:00+02:00");
  }

 private:
  std::string_view text_;
};

/// Days since 2000-01-01 12:00 UTC.
double days_since_j2000(std::string_view rfc3339) {
  TimeReader reader(rfc3339);
  const std::chrono::year year(reader.digits(4, 0, 9999));
  reader.one_of("-");
  const std::chrono::month month(static_cast<unsigned>(reader.digits(2, 1, 12)));
  reader.one_of("-");
  const std::chrono::day day(static_cast<unsigned>(reader.digits(2, 1, 31)));
  const std::chrono::year_month_day date(year, month, day);
  if (!date.ok()) TimeReader::fail();
  reader.one_of("Tt");
  double seconds = 3600.0 * reader.digits(2, 0, 23);
  reader.one_of(":");
  seconds += 60.0 * reader.digits(2, 0, 59);
  reader.one_of(":");
  seconds += reader.digits(2, 0, 60);  // 60 is a leap second
  seconds += reader.fraction();
  if (const char sign = reader.one_of("Zz+-"); sign == '+' || sign == '-') {
    double offset = 3600.0 * reader.digits(2, 0, 23);
    reader.one_of(":");
    offset += 60.0 * reader.digits(2, 0, 59);
    seconds -= sign == '+' ? offset : -offset;
  }
  reader.end();

  using namespace std::chrono_literals;
  const auto whole_days = std::chrono::sys_days(date) - std::chrono::sys_days(2000y / 1 / 1);
  const double days = static_cast<double>(whole_days.count()) + seconds / 86400;
  const auto begin =
      std::chrono::sys_days(1900y / 1 / 1) - std::chrono::sys_days(2000y / 1 / 1);
  const auto end = std::chrono::sys_days(2101y / 1 / 1) - std::chrono::sys_days(2000y / 1 / 1);
  if (days < static_cast<double>(begin.count()) || days >= static_cast<double>(end.count()))
    TimeReader::fail();
  return days - 0.5;
}

/// Terrestrial time minus universal time, seconds, linear between the years of a table. The sun
/// moves 0.01 deg in 900 s, so that the uncertainty of later years does not matter.
/// Source: The Astronomical Almanac, section K, to 2020; then F. Espenak and J. Meeus, NASA
/// TP-2006-214141 (2050 and 2100, which are predictions).
double delta_t_s(double year) {
  constexpr std::array<std::array<double, 2>, 15> table{{{1900, -2.7},
                                                         {1910, 10.5},
                                                         {1920, 21.2},
                                                         {1930, 24.0},
                                                         {1940, 24.3},
                                                         {1950, 29.1},
                                                         {1960, 33.1},
                                                         {1970, 40.2},
                                                         {1980, 50.5},
                                                         {1990, 56.9},
                                                         {2000, 63.8},
                                                         {2010, 66.1},
                                                         {2020, 69.4},
                                                         {2050, 93},
                                                         {2100, 203}}};
  const auto* upper =
      std::ranges::find_if(table, [&](const auto& row) { return row[0] > year; });
  upper = std::clamp(upper, table.begin() + 1, table.end() - 1);
  const auto& [y0, t0] = upper[-1];
  const auto& [y1, t1] = upper[0];
  return t0 + (t1 - t0) * (year - y0) / (y1 - y0);
}

// ---- The Earth's orbit

/// amplitude cos(phase + frequency t), t in thousands of Julian years from J2000.
struct Term {
  double amplitude, phase, frequency;
};

template <std::size_t N>
double sum(const std::array<Term, N>& terms, double t) {
  double total = 0;
  for (const Term& term : terms)
    total += term.amplitude * std::cos(term.phase + term.frequency * t);
  return total;
}

/// Heliocentric longitude of the Earth, radians, equinox of date: the terms of VSOP87D above
/// 0.2" (Meeus, appendix III, unit 1e-8). The latitude is below 1.2" and left out.
double earth_longitude(double t) {
  static constexpr std::array<Term, 33> l0{
      {{175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
       {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
       {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
       {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
       {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
       {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
       {902, 2.045, 26.298},        {857, 3.508, 398.149},
       {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
       {505, 4.583, 18849.228},     {492, 4.205, 775.523},
       {357, 2.92, 0.067},          {317, 5.849, 11790.629},
       {284, 1.899, 796.298},       {271, 0.315, 10977.079},
       {243, 0.345, 5486.778},      {206, 4.806, 2544.314},
       {205, 1.869, 5573.143},      {202, 2.458, 6069.777},
       {156, 0.833, 213.299},       {132, 3.411, 2942.463},
       {126, 1.083, 20.775},        {115, 0.645, 0.98},
       {103, 0.636, 4694.003},      {102, 0.976, 15720.839},
       {102, 4.267, 7.114}}};
  static constexpr std::array<Term, 6> l1{{{628331966747, 0, 0},
                                           {206059, 2.678235, 6283.07585},
                                           {4303, 2.6351, 12566.1517},
                                           {425, 1.59, 3.523},
                                           {119, 5.796, 26.298},
                                           {109, 2.966, 1577.344}}};
  static constexpr std::array<Term, 3> l2{
      {{52919, 0, 0}, {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}}};
  return 1e-8 * (sum(l0, t) + t * (sum(l1, t) + t * sum(l2, t)));
}

/// Distance to the sun, astronomical units, to 1e-4: enough for aberration and parallax.
double earth_distance_au(double t) {
  static constexpr std::array<Term, 3> r0{
      {{100013989, 0, 0}, {1670700, 3.0984635, 6283.07585}, {13956, 3.05525, 12566.1517}}};
  return 1e-8 * sum(r0, t);
}

/// Nutation in longitude and in obliquity to 0.5" (Meeus, chapter 22), radians; t in centuries.
std::array<double, 2> nutation(double t) {
  const double node = (125.04452 - 1934.136261 * t) * deg;
  const double sun = (280.4665 + 36000.7698 * t) * deg;
  const double moon = (218.3165 + 481267.8813 * t) * deg;
  return {(-17.20 * std::sin(node) - 1.32 * std::sin(2 * sun) - 0.23 * std::sin(2 * moon) +
           0.21 * std::sin(2 * node)) *
              arcsec,
          (9.20 * std::cos(node) + 0.57 * std::cos(2 * sun) + 0.10 * std::cos(2 * moon) -
           0.09 * std::cos(2 * node)) *
              arcsec};
}

/// Mean obliquity of the ecliptic (Meeus, eq. 22.2), radians; t in centuries.
double mean_obliquity(double t) {
  return 23 * deg + 26 * 60 * arcsec +
         (21.448 - t * (46.8150 + t * (0.00059 - t * 0.001813))) * arcsec;
}

/// Mean sidereal time at Greenwich (Meeus, eq. 12.4), radians; days of universal time from
/// J2000.
double sidereal_time(double days) {
  const double t = days / 36525;
  return (280.46061837 + 360.98564736629 * days + t * t * (0.000387933 - t / 38710000)) * deg;
}

}  // namespace

SunPosition sun_position(double latitude_deg, double longitude_deg, std::string_view rfc3339) {
  const double ut_days = days_since_j2000(rfc3339);
  const double tt_days = ut_days + delta_t_s(2000 + ut_days / 365.25) / 86400;
  const double centuries = tt_days / 36525;

  // Geocentric apparent position (Meeus, chapter 25, higher accuracy).
  const double distance_au = earth_distance_au(centuries / 10);
  const auto [in_longitude, in_obliquity] = nutation(centuries);
  const double aberration = -20.4898 * arcsec / distance_au;
  const double longitude =
      earth_longitude(centuries / 10) + std::numbers::pi + in_longitude + aberration;
  const double obliquity = mean_obliquity(centuries) + in_obliquity;
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  // Horizontal (Meeus, eqs. 13.5 and 13.6, the azimuth turned to count from north).
  const double hour_angle = sidereal_time(ut_days) + in_longitude * std::cos(obliquity) +
                            longitude_deg * deg - right_ascension;
  const double latitude = latitude_deg * deg;
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::sin(declination) * std::cos(latitude) -
                       std::cos(declination) * std::sin(latitude) * std::cos(hour_angle);
  const double up = std::sin(declination) * std::sin(latitude) +
                    std::cos(declination) * std::cos(latitude) * std::cos(hour_angle);
  const double elevation = std::atan2(up, std::hypot(east, north));
  const double parallax = 8.794 * arcsec / distance_au * std::cos(elevation);
  const double azimuth = std::atan2(east, north) / deg;
  return {(elevation - parallax) / deg, azimuth < 0 ? azimuth + 360 : azimuth};
}

double sidereal_time_deg(std::string_view rfc3339) {
  const double angle = std::fmod(sidereal_time(days_since_j2000(rfc3339)) / deg, 360);
  return angle < 0 ? angle + 360 : angle;
}

}  // namespace cyanometer
