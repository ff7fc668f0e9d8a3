#include "engine/optics/day.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

namespace cyanometer {
namespace {

/// Minutes after midnight of a time as 2026-06-21T05:04:20+02:00.
double minutes(const std::string& time) {
  return 60 * std::stod(time.substr(11, 2)) + std::stod(time.substr(14, 2)) +
         std::stod(time.substr(17, 2)) / 60;
}

TEST(SunDay, AtAnEquinoxHasTwelveHoursAroundTheSunsNoon) {
  // The equation of time is -7.4 minutes on 20 March [Meeus, chapter 28].
  const SunDay day = sun_day(51.48, 0, "2026-03-20", 0);
  ASSERT_TRUE(day.sunrise && day.sunset);
  EXPECT_NEAR((minutes(*day.sunrise) + minutes(*day.sunset)) / 2, 12 * 60 + 7.4, 1);
  EXPECT_NEAR(minutes(*day.sunset) - minutes(*day.sunrise), 12 * 60, 3);
  EXPECT_NEAR(minutes(day.highest.time), 12 * 60 + 7.4, 10);
}

TEST(SunDay, TheSunStandsWhereItIsSaidToPass) {
  const SunDay day = sun_day(-33.9, 18.4, "2026-11-28", 120);
  const auto at = [](const std::optional<std::string>& time) {
    return sun_position(-33.9, 18.4, time.value()).elevation_deg;
  };
  const double a_second = 0.005;  // in deg
  EXPECT_NEAR(at(day.dawn), -6, a_second);
  EXPECT_NEAR(at(day.sunrise), 0, a_second);
  EXPECT_NEAR(at(day.sunset), 0, a_second);
  EXPECT_NEAR(at(day.dusk), -6, a_second);
  EXPECT_LT(*day.dawn, *day.sunrise);
  EXPECT_LT(*day.sunrise, day.highest.time);
  EXPECT_LT(day.highest.time, *day.sunset);
  EXPECT_LT(*day.sunset, *day.dusk);
}

TEST(SunDay, NoSunPassesTheHorizonAtThePoleInSummerOrWinter) {
  for (const char* date : {"2026-06-21", "2026-12-21"}) {
    const SunDay day = sun_day(89, 0, date, 0);
    EXPECT_FALSE(day.dawn || day.sunrise || day.sunset || day.dusk) << date;
    EXPECT_EQ(day.moments.size(), 145u);
  }
}

TEST(SunDay, AnotherClockTellsTheSameMoments) {
  const SunDay here = sun_day(48.85, 2.35, "2026-06-21", 90),
               there = sun_day(48.85, 2.35, "2026-06-21", 0);
  EXPECT_THAT(*here.sunrise, ::testing::EndsWith("+01:30"));
  EXPECT_NEAR(minutes(*here.sunrise), minutes(*there.sunrise) + 90, 0.05);
  EXPECT_THAT(*sun_day(19.8, -155.5, "2026-06-21", -630).sunrise,
              ::testing::EndsWith("-10:30"));
}

TEST(SunDay, RefusesWhatIsNoDate) {
  for (const char* date :
       {"2026-02-30", "yesterday", "", "2200-01-01", "2026-06-21T00:00:00Z"}) {
    EXPECT_THROW(sun_day(0, 0, date, 0), std::invalid_argument) << date;
  }
}

}  // namespace
}  // namespace cyanometer
