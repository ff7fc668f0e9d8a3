// POST and GET /v1/plan: what would be done for a scene.
#include <nlohmann/json.hpp>

#include "engine/attention.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Answer plan(const json& document, const Request& request, Service& service) {
  const Watch watch = service.watch(request);
  const auto asked = scene_request(document);
  check_frame(asked.scene, service.config);
  const Plan plan = service.plans.get(asked.scene, request.peer, watch).plan;
  check_memory(asked.scene, plan, service.config);
  const Attention attention(watch);
  return json_answer(plan_document(asked.scene, plan));
}

json plan_operation() {
  const json number{{"type", "number"}}, text{{"type", "string"}};
  const json schema{{"type", "object"},
                    {"properties",
                     {{"scene", openapi::scene_schema_reference()},
                      {"method", text},
                      {"options", {{"type", "object"}, {"additionalProperties", number}}},
                      {"wavelengths_nm", {{"type", "array"}, {"items", number}}},
                      {"error", number},
                      {"ms", number},
                      {"met", {{"type", "boolean"}}},
                      {"why", text},
                      {"limits", {{"type", "array"}, {"items", text}}},
                      {"atmosphere", text}}}};
  return {
      {"responses", openapi::responses(openapi::json_content(schema), {411, 422, 429, 504})}};
}

}  // namespace

Route plan_post() {
  return {"POST", "/v1/plan", "What would be done for a scene",
          [] {
            json out = plan_operation();
            out["requestBody"] = openapi::json_body(openapi::scene_schema_reference());
            return out;
          },
          [](const Request& request, Service& service) {
            return plan(body_document(request), request, service);
          }};
}

Route plan_link() {
  return {"GET", "/v1/plan", "What would be done for the scene that a link describes",
          [] {
            json out = plan_operation();
            out["parameters"] = openapi::link_parameters();
            return out;
          },
          [](const Request& request, Service& service) {
            return plan(link_document(request), request, service);
          }};
}

}  // namespace cyanometer
