#include "server/routes/openapi.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/scene/document.h"
#include "server/http/problem.h"
#include "server/routes/json_answer.h"
#include "server/routes/route.h"

namespace cyanometer {

using nlohmann::json;

namespace openapi {
namespace {

json problem_schema() {
  const json text{{"type", "string"}};
  return {{"type", "object"},
          {"description", "RFC 9457. `pointer` names the member of the body that is refused."},
          {"required", {"type", "title", "status", "detail"}},
          {"properties",
           {{"type", text},
            {"title", text},
            {"status", {{"type", "integer"}}},
            {"detail", text},
            {"instance", text},
            {"pointer", text},
            {"given", text},
            {"allowed", text},
            {"retry_after_s", {{"type", "integer"}}}}}};
}

/// The scene's schema refers to its own root; with an id of its own it may stand inside another
/// document (JSON Schema 2020-12, section 8.2.1).
json embedded_scene_schema() {
  json schema = scene_schema();
  if (!schema.contains("$id")) schema["$id"] = "/v1/schema";
  return schema;
}

json problem_response(int status) {
  return {{"description", status_phrase(status)},
          {"content",
           {{"application/problem+json",
             {{"schema", {{"$ref", "#/components/schemas/Problem"}}}}}}}};
}

/// What any request may be answered: one that cannot be read as HTTP, or with a token that is
/// not the right one, and where there is no room or device.
void add_common_problems(json& operation) {
  json& all = operation["responses"];
  for (const int status : {400, 401, 408, 413, 414, 415, 417, 431, 503}) {
    const std::string name = std::to_string(status);
    if (!all.contains(name)) all[name] = problem_response(status);
  }
}

std::string operation_id(const Route& route) {
  std::string id = route.method + route.path;
  std::ranges::transform(id, id.begin(), [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    return letter ? c : c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : '_';
  });
  return id;
}

}  // namespace

json json_body(const json& schema) {
  return {{"required", true}, {"content", {{"application/json", {{"schema", schema}}}}}};
}

json scene_schema_reference() { return {{"$ref", "#/components/schemas/Scene"}}; }

json link_parameters() {
  return json::array(
      {{{"name", "scene"},
        {"in", "query"},
        {"style", "form"},
        {"explode", true},
        {"description",
         "Dotted paths of scene members, as `preset=mars&sun.elevation_deg=4`; values are JSON "
         "where they parse, else strings; a path given twice is refused."},
        {"schema", {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}}}});
}

json json_content(const json& schema) { return {{"application/json", {{"schema", schema}}}}; }

json responses(const json& content, std::initializer_list<int> problems) {
  json out{{"200", {{"description", "OK"}, {"content", content}}}};
  for (const int status : problems) out[std::to_string(status)] = problem_response(status);
  return out;
}

void add_header(json& operation_responses, const std::string& name,
                const std::string& description) {
  operation_responses["200"]["headers"][name] = {{"description", description},
                                                 {"schema", {{"type", "string"}}}};
}

json document() {
  json paths = json::object();
  for (const Route& route : routes()) {
    json operation = route.operation();
    operation["summary"] = route.summary;
    operation["operationId"] = operation_id(route);
    add_common_problems(operation);
    std::string method = route.method;
    std::ranges::transform(method, method.begin(),
                           [](char c) { return static_cast<char>(c + ('a' - 'A')); });
    paths[route.path][method] = operation;
  }
  return {
      {"openapi", "3.1.0"},
      {"jsonSchemaDialect", "https://json-schema.org/draft/2020-12/schema"},
      {"info",
       {{"title", "Cyanometer"},
        {"version", version()},
        {"description",
         "Renders atmospheric scattering. Scalar, unrefracted transfer in a spherical shell; "
         "every answer states its error."}}},
      {"paths", paths},
      {"components",
       {{"schemas", {{"Scene", embedded_scene_schema()}, {"Problem", problem_schema()}}}}}};
}

}  // namespace openapi

Route openapi_document() {
  return {"GET", "/openapi.json", "This document",
          [] {
            return json{{"responses",
                         openapi::responses(openapi::json_content({{"type", "object"}}), {})}};
          },
          [](const Request& request, Service&) {
            static const Answer answer = json_answer(openapi::document());
            static const std::string tag = entity_tag({answer.body});
            return with_tag(answer, request, tag);
          }};
}

}  // namespace cyanometer
