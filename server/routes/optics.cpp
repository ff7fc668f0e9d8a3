// POST /v1/optics: a scene's constituents as curves.
#include <nlohmann/json.hpp>

#include "engine/attention.h"
#include "engine/physics/curves.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json curves_document(const Curves& curves) {
  json constituents = json::object();
  for (const ConstituentCurves& each : curves.constituents) {
    json& out = constituents[each.name];
    out = {{"density", each.density},
           {"scattering_per_km", each.scattering_per_km},
           {"absorption_per_km", each.absorption_per_km},
           {"optical_depth", each.optical_depth},
           {"phase", nullptr},
           {"visibility_km", nullptr}};
    if (!each.phase.empty()) out["phase"] = each.phase;
    if (each.visibility_km) out["visibility_km"] = *each.visibility_km;
  }
  return {{"altitude_km", curves.altitude_km},
          {"wavelengths_nm", curves.wavelengths_nm},
          {"angle_deg", curves.angle_deg},
          {"phase_wavelengths_nm", curves.phase_wavelengths_nm},
          {"constituents", constituents}};
}

Answer optics(const Request& request, Service& service) {
  const Watch watch = service.watch(request);
  const Attention attention(watch);
  const auto asked = scene_request(body_document(request));
  check_scene(asked.scene, service.config);
  return json_answer(curves_document(constituent_curves(asked.scene)));
}

json optics_operation() {
  const json list{{"type", "array"}, {"items", {{"type", "number"}}}};
  const auto described = [](json schema, const char* description) {
    schema["description"] = description;
    return schema;
  };
  const json constituent{
      {"type", "object"},
      {"properties",
       {{"density", described(list, "By altitude; 1 where the coefficients hold.")},
        {"scattering_per_km", described(list, "By wavelength.")},
        {"absorption_per_km", described(list, "By wavelength.")},
        {"optical_depth",
         described(list, "By wavelength: of extinction, vertical, from ground to top.")},
        {"phase",
         described({{"type", {"array", "null"}}, {"items", list}},
                   "By phase wavelength and angle, 1/sr; null where nothing scatters.")},
        {"visibility_km",
         described({{"type", {"number", "null"}}},
                   "3.912 over the extinction nearest to 550 nm where the density is 1.")}}}};
  const json answer{
      {"type", "object"},
      {"properties",
       {{"altitude_km", list},
        {"wavelengths_nm",
         described(list, "The scene's, or 380 to 730 nm where it leaves them open.")},
        {"angle_deg", described(list, "0 is forward.")},
        {"phase_wavelengths_nm", list},
        {"constituents", {{"type", "object"}, {"additionalProperties", constituent}}}}}};
  return {{"requestBody", openapi::json_body(openapi::scene_schema_reference())},
          {"responses", openapi::responses(openapi::json_content(answer), {411, 422, 504})}};
}

}  // namespace

Route optics_post() {
  return {"POST", "/v1/optics", "Profiles, phases and coefficients of a scene's constituents",
          optics_operation, optics};
}

}  // namespace cyanometer
