// POST /v1/explain: what each ingredient of a scene is worth, with the share done while it
// works.
#include "engine/accuracy/ingredients.h"

#include <atomic>
#include <chrono>
#include <future>
#include <nlohmann/json.hpp>

#include "server/current_problem.h"
#include "server/http/accept.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json explained(const Request& request, Service& service, const Scene& scene,
               const Watch& watch) {
  std::vector<Worth> ingredients;
  service.queue.run(
      {.client = request.peer, .watch = watch, .work = [&](Engine& engine, const Watch& w) {
         ingredients = explain(engine, scene, w);
       }});
  return explanation_document(ingredients);
}

constexpr std::chrono::milliseconds pace{200};  // of lines while it works

/// An explanation while it is made: the queue's thread works, the connection's own tells how
/// far it is, so that a slow reader never holds the device.
class LiveExplanation {
 public:
  LiveExplanation(Request request, Service& service, Scene scene)
      : request_(std::move(request)), scene_(std::move(scene)) {
    ingredients_ = std::async(std::launch::async, [this, &service] {
      Watch watch = service.watch(request_);
      watch.progress = [this](double share) { share_ = share; };
      return explained(request_, service, scene_, watch);
    });
  }

  /// Until it works. What hinders it before is answered as everywhere.
  void start() const {
    while (!done() && share_ == 0) continue;
    if (done()) ingredients_.get();
  }

  void send(const Write& write) const {
    const auto line = [&](const json& value) { return write(value.dump() + "\n"); };
    try {
      do {
        if (!line({{"progress", share_.load()}})) return;
      } while (!done());
      line({{"progress", 1}, {"ingredients", ingredients_.get()}});
    } catch (...) {
      line(json::parse(problem_json(current_problem(), request_.id)));
    }
  }

 private:
  bool done() const { return ingredients_.wait_for(pace) == std::future_status::ready; }

  Request request_;
  Scene scene_;
  std::atomic<double> share_ = 0;
  std::shared_future<json> ingredients_;  ///< last: its end is waited for before the rest goes
};

Answer explain_request(const Request& request, Service& service) {
  const bool live =
      negotiated(request.header("accept"), {"application/json", "application/x-ndjson"}) == 1;
  service.admission.check(request);
  const auto asked = scene_request(body_document(request));
  check_frame(asked.scene, service.config);
  if (!live) {
    return json_answer(explained(request, service, asked.scene, service.watch(request)));
  }
  const auto explanation = std::make_shared<LiveExplanation>(request, service, asked.scene);
  explanation->start();
  return {.headers = {{"Content-Type", "application/x-ndjson"}, {"Cache-Control", "no-store"}},
          .stream = [explanation](const Write& write) { explanation->send(write); }};
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
  const json answer{
      {"type", "object"},
      {"description",
       "By the name of each constituent (after \"constituent.\" where it is one of the "
       "others), "
       "multiple_scattering, order_2, order_3, ..., curvature, ground, wavelength_4, ..."},
      {"additionalProperties", worth}};
  const json line{
      {"type", "object"},
      {"description", "A line while it works; the last has the ingredients, or is a problem."},
      {"properties",
       {{"progress", number("number", "Share done, 0 to 1.")}, {"ingredients", answer}}}};
  json content = openapi::json_content(answer);
  content["application/x-ndjson"] = {{"schema", line}};
  return {{"requestBody", openapi::json_body(openapi::scene_schema_reference())},
          {"responses",
           openapi::responses(content, {400, 406, 408, 411, 413, 415, 422, 429, 503, 504})}};
}

}  // namespace

Route explain_post() {
  return {"POST", "/v1/explain", "What each ingredient of a scene is worth", explain_operation,
          explain_request};
}

}  // namespace cyanometer
