// POST and GET /v1/render: scene in, image out.
#include <nlohmann/json.hpp>

#include "server/routes/frame.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// How long others may keep it.
void add_caching(Answer& answer, const Scene& scene, bool link) {
  const bool timed = scene.method.max_ms.has_value();
  answer.headers.emplace_back("Cache-Control", timed  ? "no-store"
                                               : link ? "max-age=300"
                                                      : "no-cache");
  if (link) answer.headers.emplace_back("Vary", "Accept");
}

Answer render(const PlannedFrame& planned, const Request& request, Service& service, bool link,
              const Watch& watch) {
  const auto got = get_frame(planned, request.peer, service, watch, true);
  Answer answer;
  answer.headers = planned_fields(planned);
  add_caching(answer, planned.asked.scene, link);
  answer.headers.emplace_back("ETag", planned.tag);
  for (auto& field : frame_fields(planned, got, service)) {
    answer.headers.push_back(std::move(field));
  }
  answer.shared_body = {got.frame, &got.frame->bytes};
  answer.held = got.memory;
  return answer;
}

/// The answer that needs no frame: 304 for the frame the client has, or a HEAD.
std::optional<Answer> without_frame(const PlannedFrame& planned, const Request& request) {
  if (request.method != "HEAD" && !matches(request, planned.tag)) return std::nullopt;
  Answer answer;
  answer.headers = planned_fields(planned);
  add_caching(answer, planned.asked.scene, true);
  answer.length_known = false;
  return with_tag(answer, request, planned.tag);
}

PlannedFrame frame_request(const json& document, const Request& request, Service& service,
                           const Watch& watch) {
  const auto asked = scene_request(negotiate_format(document, request));
  check_frame(asked.scene, service.config);
  auto planned = plan_frame(asked, request.peer, service, watch);
  check_memory(asked.scene, planned.plan, service.config);
  service.admission.remember(request);
  return planned;
}

}  // namespace

Route render_post() {
  return {"POST", "/v1/render", "Render a scene",
          [] {
            json out = frame_operation();
            out["requestBody"] = openapi::json_body(openapi::scene_schema_reference());
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            service.admission.check(request);
            const auto planned = frame_request(body_document(request), request, service, watch);
            return render(planned, request, service, false, watch);
          }};
}

Route render_link() {
  return {"GET", "/v1/render", "Render the scene that a link describes",
          [] {
            json out = frame_operation();
            out["parameters"] = openapi::link_parameters();
            out["responses"]["304"] = {{"description", "The frame is the one the client has."}};
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            service.admission.check(request);
            const auto planned = frame_request(link_document(request), request, service, watch);
            if (auto answer = without_frame(planned, request)) return *answer;
            return render(planned, request, service, true, watch);
          }};
}

}  // namespace cyanometer
