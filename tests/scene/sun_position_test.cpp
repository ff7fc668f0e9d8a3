// The sun's place against published values.
#include "engine/optics/sun_position.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace cyanometer {
namespace {

double degrees(double d, double minutes, double seconds) {
  return d + minutes / 60 + seconds / 3600;
}

// I. Reda and A. Andreas, Solar Position Algorithm for Solar Radiation Applications, NREL
// TP-560-34302 (2008), table A5.1: the zenith 50.11162 there has 0.016332 of refraction in it.
TEST(SunPosition, TheWorkedExampleOfNrelIsMet) {
  const SunPosition sun = sun_position(39.742476, -105.1786, "2003-10-17T12:30:30-07:00");
  EXPECT_NEAR(sun.elevation_deg, 90 - 50.11162 - 0.016332, 0.0005);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.0005);
}

// Meeus, Astronomical Algorithms (1998), example 25.b: 1992 October 13.0 TD (UTC is 59 s
// behind), declination -7 deg 47' 01.74". At a pole the elevation is the declination, less
// parallax.
TEST(SunPosition, AtThePoleTheElevationIsTheDeclination) {
  const double declination = -degrees(7, 47, 1.74);
  const double parallax = 8.794 / 3600 * std::cos(declination * 0.0174533);
  const SunPosition north = sun_position(90, 0, "1992-10-12T23:59:01Z");
  EXPECT_NEAR(north.elevation_deg, declination - parallax, 0.0005);
  const SunPosition south = sun_position(-90, 0, "1992-10-12T23:59:01Z");
  EXPECT_NEAR(south.elevation_deg, -declination - parallax, 0.0005);
}

// Meeus, examples 12.a and 12.b.
TEST(SiderealTime, TheWorkedExamplesOfMeeusAreMet) {
  EXPECT_NEAR(sidereal_time_deg("1987-04-10T00:00:00Z"), 15 * degrees(13, 10, 46.3668), 1e-6);
  EXPECT_NEAR(sidereal_time_deg("1987-04-10T19:21:00Z"), 15 * degrees(8, 34, 57.0896), 1e-6);
}

// Meeus, example 28.a: the equation of time is then +13 m 42.6 s, so that the sun is in the
// south where the mean solar time is that much before noon.
TEST(SunPosition, AtTrueNoonTheSunIsInTheSouth) {
  const double universal_hours = 24 - 59.0 / 3600;
  const double equation_of_time_hours = degrees(0, 13, 42.6);
  const double longitude = 15 * (12 - equation_of_time_hours - universal_hours) + 360;
  const SunPosition sun = sun_position(45, longitude, "1992-10-12T23:59:01Z");
  EXPECT_NEAR(sun.azimuth_deg, 180, 0.005);
}

// Meeus, table 27.E (equinoxes and solstices, TD): 1996 March 20 08:04:07, September 22
// 18:01:08; the declination is 0 there. TD was 62 s ahead of UTC.
TEST(SunPosition, AtTheEquinoxesTheSunCrossesTheEquator) {
  for (const char* time : {"1996-03-20T08:03:05Z", "1996-09-22T18:00:06Z"})
    EXPECT_NEAR(sun_position(90, 0, time).elevation_deg, -8.794 / 3600, 0.0005) << time;
}

// Meeus, example 27.a: the June solstice of 1962 at 21:24:42 TD, 33 s ahead of UT.
TEST(SunPosition, AtTheSolsticeTheDeclinationIsGreatest) {
  const double before = sun_position(90, 0, "1962-06-21T09:24:09Z").elevation_deg;
  const double at = sun_position(90, 0, "1962-06-21T21:24:09Z").elevation_deg;
  const double after = sun_position(90, 0, "1962-06-22T09:24:09Z").elevation_deg;
  EXPECT_GT(at, before);
  EXPECT_GT(at, after);
  EXPECT_NEAR(before, after, 0.0005);
}

TEST(SunPosition, TheOffsetIsPartOfTheTime) {
  const SunPosition utc = sun_position(48, 2, "2024-06-20T10:30:00Z");
  for (const char* same : {"2024-06-20T12:30:00+02:00", "2024-06-20t10:30:00.000z",
                           "2024-06-20T05:00:00-05:30", "2024-06-21T00:30:00+14:00"}) {
    EXPECT_NEAR(sun_position(48, 2, same).elevation_deg, utc.elevation_deg, 1e-9) << same;
    EXPECT_NEAR(sun_position(48, 2, same).azimuth_deg, utc.azimuth_deg, 1e-9) << same;
  }
  EXPECT_NE(sun_position(48, 2, "2024-06-20T10:30:00.5Z").azimuth_deg, utc.azimuth_deg);
  EXPECT_NEAR(sun_position(48, 362, "2024-06-20T10:30:00Z").elevation_deg, utc.elevation_deg,
              1e-9);
}

TEST(SunPosition, WhatIsNoTimeIsRefused) {
  for (const char* bad :
       {"", "2024", "2024-06-20", "2024-06-20T10:30:00", "2024-06-20 10:30:00Z",
        "2024-02-30T00:00:00Z", "2023-02-29T00:00:00Z", "2024-13-01T00:00:00Z",
        "2024-06-20T24:00:00Z", "2024-06-20T10:60:00Z", "2024-06-20T10:30:61Z",
        "2024-06-20T10:30:00.Z", "2024-06-20T10:30:00+2:00", "2024-06-20T10:30:00+24:00",
        "2024-06-20T10:30:00Z ", "-024-06-20T10:30:00Z", "2024-06-20T10:30:00+0200"})
    EXPECT_THROW(sun_position(0, 0, bad), std::invalid_argument) << bad;
  EXPECT_NO_THROW(sun_position(0, 0, "2024-02-29T00:00:00Z"));
  EXPECT_NO_THROW(sun_position(0, 0, "2016-12-31T23:59:60Z"));
}

TEST(SunPosition, YearsFrom1900To2100AreAllowed) {
  EXPECT_NO_THROW(sun_position(0, 0, "1900-01-01T00:00:00Z"));
  EXPECT_NO_THROW(sun_position(0, 0, "2100-12-31T23:59:59Z"));
  EXPECT_THROW(sun_position(0, 0, "1899-12-31T23:59:59Z"), std::invalid_argument);
  EXPECT_THROW(sun_position(0, 0, "2101-01-01T00:00:00Z"), std::invalid_argument);
  EXPECT_THROW(sun_position(0, 0, "1900-01-01T00:00:00+01:00"), std::invalid_argument);
}

}  // namespace
}  // namespace cyanometer
