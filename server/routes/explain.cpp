// POST /v1/explain: what each ingredient of a scene is worth.
#include <nlohmann/json.hpp>

#include "engine/accuracy/ingredients.h"
#include "server/http/accept.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Answer explain_request(const Request& request, Service& service) {
  negotiated(request.header("accept"), {"application/json"});
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const auto asked = scene_request(body_document(request));
  check_frame(asked.scene, service.config);
  std::vector<Worth> ingredients;
  service.queue.run(
      {.client = request.peer, .watch = watch, .work = [&](Engine& engine, const Watch& w) {
         ingredients = explain(engine, asked.scene, w);
       }});
  return json_answer(explanation_document(ingredients));
}

json operation() {
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
  const json answer{
      {"type", "object"},
      {"description",
       "By the name of each constituent (after \"constituent.\" where it is one of the "
       "others), "
       "multiple_scattering, order_2, order_3, ..., curvature, ground, wavelength_4, ..."},
      {"additionalProperties", worth}};
  return {
      {"requestBody", openapi::json_body(openapi::scene_schema_reference())},
      {"responses", openapi::responses(openapi::json_content(answer),
                                       {400, 406, 408, 411, 413, 415, 422, 429, 503, 504})}};
}

}  // namespace

Route explain_post() {
  return {"POST", "/v1/explain", "What each ingredient of a scene is worth", operation,
          explain_request};
}

}  // namespace cyanometer
