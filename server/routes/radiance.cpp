// POST /v1/radiance: numbers for directions.
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/reading.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// What the answer takes while it is made, about: each number as such, as JSON and as text.
std::size_t answer_bytes(const RadianceRequest& asked) {
  constexpr std::size_t bytes_of_number = 128;
  constexpr std::size_t most_of_auto = 32;  // wavelengths
  const std::size_t given = asked.scene.spectrum.wavelengths_nm.size();
  const std::size_t spectra = 3 * (given > 0 ? given : most_of_auto), colours = 4;
  return asked.directions.size() * (spectra + colours) * bytes_of_number;
}

Answer radiance(const Request& request, Service& service) {
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const auto asked = read_radiance_request(body_document(request));
  Radiances radiances;
  Ticket ticket;
  within("/scene", [&] {
    check_scene(asked.scene, service.config);
    ticket = service.queue.run({.client = request.peer,
                                .frame_bytes = answer_bytes(asked),
                                .watch = watch,
                                .work = [&](Engine& engine, const Watch& w) {
                                  radiances = engine.radiance(asked.scene, asked.directions,
                                                              asked.irradiance, w);
                                }});
  });
  Answer answer = json_answer(radiance_document(asked.scene, radiances));
  answer.held = service.queue.hold(answer.body.size());
  return answer;
}

json radiance_operation() {
  const auto angle = [](double limit) {
    return json{{"type", "number"}, {"minimum", -limit}, {"maximum", limit}};
  };
  const json list{{"type", "array"}, {"items", {{"type", "number"}}}};
  const json table{{"type", "array"}, {"items", list}};
  const json direction{
      {"type", "object"},
      {"required", {"elevation_deg", "azimuth_deg"}},
      {"properties", {{"elevation_deg", angle(90)}, {"azimuth_deg", angle(360)}}},
      {"additionalProperties", false}};
  const json body{{"type", "object"},
                  {"required", {"directions"}},
                  {"properties",
                   {{"scene", openapi::scene_schema_reference()},
                    {"directions",
                     {{"type", "array"},
                      {"minItems", 1},
                      {"maxItems", most_directions},
                      {"items", direction}}},
                    {"irradiance", {{"type", "boolean"}, {"default", false}}}}},
                  {"additionalProperties", false}};
  json maybe_table = table;
  maybe_table["type"] = {"array", "null"};
  const json answer{
      {"type", "object"},
      {"properties",
       {{"wavelengths_nm", list},
        {"radiance", table},
        {"standard_error", maybe_table},
        {"transmittance", table},
        {"method", {{"type", "string"}}},
        {"error", {{"type", "number"}}},
        {"rgb",
         {{"type", "array"},
          {"items", list},
          {"description", "By direction, in the unit of an EXR's R, G, B."}}},
        {"luminance_cd_m2",
         {{"type", {"array", "null"}},
          {"items", {{"type", "number"}}},
          {"description", "By direction; null where the three wavelengths are R, G, B."}}},
        {"irradiance",
         {{"type", "object"},
          {"properties", {{"direct", list}, {"diffuse_down", list}, {"diffuse_up", list}}}}}}}};
  return {
      {"requestBody", openapi::json_body(body)},
      {"responses", openapi::responses(openapi::json_content(answer), {411, 422, 429, 504})}};
}

}  // namespace

Route radiance_post() {
  return {"POST", "/v1/radiance", "Spectral radiance in directions", radiance_operation,
          radiance};
}

}  // namespace cyanometer
