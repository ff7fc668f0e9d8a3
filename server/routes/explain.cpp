// POST /v1/explain: what each ingredient of a scene is worth.
#include "engine/accuracy/ingredients.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/live_document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Answer explain_request(const Request& request, Service& service) {
  return live_document(request, service, "ingredients",
                       [](Engine& engine, const Scene& scene, const Watch& watch) {
                         return explanation_document(explain(engine, scene, watch));
                       });
}

json explain_operation() {
  const auto number = [](const json& type, const char* description) {
    return json{{"type", type}, {"description", description}};
  };
  const json worth{
      {"type", "object"},
      {"properties",
       {{"error", number("number", "Of the scene without it against the scene with it.")},
        {"ciede2000",
         number({"number", "null"}, "99th percentile of colour differences as displayed.")},
        {"ms_saved", number("number", "Planned device time that leaving it out saves.")}}}};
  return live_document_operation(
      "ingredients",
      {{"type", "object"},
       {"description",
        "By the name of each constituent (after \"constituent.\" where it is one of the "
        "others), "
        "multiple_scattering, order_2, order_3, ..., curvature, ground, wavelength_4, ..."},
       {"additionalProperties", worth}});
}

}  // namespace

Route explain_post() {
  return {"POST", "/v1/explain", "What each ingredient of a scene is worth", explain_operation,
          explain_request};
}

}  // namespace cyanometer
