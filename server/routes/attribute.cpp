// POST /v1/attribute: where the error of a scene's method comes from.
#include "engine/accuracy/attribution.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/live_document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Of somebody who waits for it.
constexpr ReferenceGoal live_goal{.rays = 96, .noise = 0.01, .most_walks = 1024};

Answer attribute_request(const Request& request, Service& service) {
  return live_document(
      request, service, "attribution",
      [](Engine& engine, const Scene& scene, const Watch& watch) {
        return attribution_document(attribute(engine, scene, live_goal, {}, watch));
      });
}

json attribute_operation() {
  const json number{{"type", "number"}};
  const json list{{"type", "array"}, {"items", number}};
  const json share{
      {"type", "object"},
      {"properties",
       {{"cause",
         {{"type", "string"},
          {"description", "quadrature, tables, orders, model, wavelengths or walks"}}},
        {"error", number},
        {"how", {{"type", "string"}, {"description", "What was compared."}}}}}};
  return live_document_operation(
      "attribution",
      {{"type", "object"},
       {"description",
        "Of the setting that the scene's method asks for, or that auto chooses: its error "
        "against random walks, and what each cause alone is worth. Shares need not add up."},
       {"properties",
        {{"method", {{"type", "string"}}},
         {"options", {{"type", "object"}, {"additionalProperties", number}}},
         {"wavelengths_nm", list},
         {"error", number},
         {"error_95", list},
         {"reference_noise", number},
         {"shares", {{"type", "array"}, {"items", share}}}}}});
}

}  // namespace

Route attribute_post() {
  return {"POST", "/v1/attribute", "Where the error of a scene's method comes from",
          attribute_operation, attribute_request};
}

}  // namespace cyanometer
