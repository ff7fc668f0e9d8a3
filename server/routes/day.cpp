// POST /v1/day: where the sun stands over a place through a day.
#include <nlohmann/json.hpp>

#include "engine/optics/day.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/reading.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

constexpr int most_offset_min = 14 * 60;
/// As of sun.place.
constexpr double most_latitude_deg = 90, most_longitude_deg = 360;

double read_number(const json& document, const std::string& name, double limit) {
  const std::string pointer = "/" + name;
  const std::string allowed =
      "a number from " + json(-limit).dump() + " to " + json(limit).dump();
  const auto found = document.find(name);
  if (found == document.end()) miss(pointer, allowed);
  if (!found->is_number()) refuse(pointer, *found, allowed);
  const double value = found->get<double>();
  if (!(value >= -limit && value <= limit)) refuse(pointer, *found, allowed);
  return value;
}

int read_offset(const json& document) {
  const auto found = document.find("utc_offset_min");
  if (found == document.end()) return 0;
  const bool whole = found->is_number_integer();
  if (!whole || std::abs(found->get<double>()) > most_offset_min) {
    refuse("/utc_offset_min", *found, "a whole number of minutes from -840 to 840");
  }
  return found->get<int>();
}

SunDay read_day(const json& document) {
  check_members(document, "", {"latitude_deg", "longitude_deg", "date", "utc_offset_min"});
  const double latitude = read_number(document, "latitude_deg", most_latitude_deg);
  const double longitude = read_number(document, "longitude_deg", most_longitude_deg);
  const int offset = read_offset(document);
  const std::string allowed = "a date from 1900 to 2100, such as 2024-06-20";
  const auto date = document.find("date");
  if (date == document.end()) miss("/date", allowed);
  if (!date->is_string()) refuse("/date", *date, allowed);
  try {
    return sun_day(latitude, longitude, date->get<std::string>(), offset);
  } catch (const std::invalid_argument&) {
    refuse("/date", *date, allowed);
  }
}

json moment_document(const DayMoment& moment) {
  return {{"time", moment.time},
          {"elevation_deg", moment.sun.elevation_deg},
          {"azimuth_deg", moment.sun.azimuth_deg}};
}

Answer day(const Request& request, Service&) {
  const SunDay day = read_day(body_document(request));
  const auto or_null = [](const std::optional<std::string>& time) {
    return time ? json(*time) : json(nullptr);
  };
  json moments = json::array();
  for (const DayMoment& moment : day.moments) moments.push_back(moment_document(moment));
  return json_answer({{"dawn", or_null(day.dawn)},
                      {"sunrise", or_null(day.sunrise)},
                      {"sunset", or_null(day.sunset)},
                      {"dusk", or_null(day.dusk)},
                      {"highest", moment_document(day.highest)},
                      {"moments", moments}});
}

json day_operation() {
  const auto number = [](double limit) {
    return json{{"type", "number"}, {"minimum", -limit}, {"maximum", limit}};
  };
  const json body{
      {"type", "object"},
      {"required", {"latitude_deg", "longitude_deg", "date"}},
      {"properties",
       {{"latitude_deg", number(most_latitude_deg)},
        {"longitude_deg", number(most_longitude_deg)},
        {"date", {{"type", "string"}, {"format", "date"}}},
        {"utc_offset_min",
         {{"type", "integer"},
          {"minimum", -most_offset_min},
          {"maximum", most_offset_min},
          {"default", 0},
          {"description", "Of the clock that the day and its times are told by."}}}}},
      {"additionalProperties", false}};
  const json time{{"type", {"string", "null"}}, {"format", "date-time"}};
  const json moment{{"type", "object"},
                    {"properties",
                     {{"time", {{"type", "string"}, {"format", "date-time"}}},
                      {"elevation_deg", {{"type", "number"}}},
                      {"azimuth_deg", {{"type", "number"}}}}}};
  json moments{{"type", "array"}, {"items", moment}};
  const json answer{
      {"type", "object"},
      {"description",
       "Geometric, unrefracted: dawn and dusk are the disc's centre at -6 degrees, "
       "sunrise and sunset at 0; null where that day has none."},
      {"properties",
       {{"dawn", time},
        {"sunrise", time},
        {"sunset", time},
        {"dusk", time},
        {"highest", moment},
        {"moments", moments}}}};
  return {{"requestBody", openapi::json_body(body)},
          {"responses", openapi::responses(openapi::json_content(answer), {411})}};
}

}  // namespace

Route day_post() {
  return {"POST", "/v1/day", "Where the sun stands over a place through a day", day_operation,
          day};
}

}  // namespace cyanometer
