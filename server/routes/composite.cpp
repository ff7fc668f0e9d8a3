// POST /v1/composite: a client's picture with the scene's air laid over it.
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>

#include "engine/attention.h"
#include "engine/fingerprint.h"
#include "engine/image/picture.h"
#include "engine/scene/document.h"
#include "server/http/problem.h"
#include "server/routes/composite_scene.h"
#include "server/routes/frame.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/reading.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

/// A scene, and what 1.0 in the picture is worth in the unit of the frame's files.
struct Asked {
  SceneRequest scene;
  double scale = 1;
};

double read_scale(const std::string& text) {
  double scale = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, scale);
  if (read.ptr != end || read.ec != std::errc{} ||
      !(scale >= least_scale && scale <= most_scale)) {
    refuse("/scale", text, "a number from 1e-12 to 1e12");
  }
  return scale;
}

/// Takes `scale` out of a link, which has the scene's members beside it.
double take_scale(Fields& query) {
  double scale = 1;
  int given = 0;
  std::erase_if(query, [&](const auto& field) {
    if (field.first != "scale") return false;
    scale = read_scale(field.second);
    ++given;
    return true;
  });
  if (given > 1) refuse("/scale", given, "given once");
  return scale;
}

[[noreturn]] void refuse_picture(const std::string& why) {
  HttpProblem problem(400, why);
  problem.allowed = "an EXR with R, G, B, and Z in km along each ray";
  throw problem;
}

/// What `read` gives; what is wrong with the picture as a problem.
template <class Read>
auto of_picture(Read read) {
  try {
    return read();
  } catch (const ImageError& error) {
    refuse_picture(error.what());
  }
}

Asked read_asked(const Request& request, const Service& service) {
  Asked asked;
  Fields query = request.query;
  asked.scale = take_scale(query);
  const json document = negotiate_format(document_from_query(query), request);
  if (request.body.empty()) refuse_picture("The body is empty.");
  asked.scene = scene_request(of_picture([&] { return sized_as(document, request.body); }));
  check_composite(asked.scene.scene);
  check_frame(asked.scene.scene, service.config);
  return asked;
}

/// Beside the frame: the picture, here and on the device.
std::size_t picture_bytes(const Scene& scene) {
  return 2 * 4 * sizeof(float) * static_cast<std::size_t>(scene.image.width) *
         static_cast<std::size_t>(scene.image.height);
}

std::string composite_tag(const Asked& asked, const Plan& plan, const Request& request,
                          const Service& service) {
  return entity_tag({frame_tag(asked.scene, plan, service), shortest(asked.scale),
                     fingerprint(request.body)});
}

Answer composite(const Request& request, Service& service) {
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const Asked asked = read_asked(request, service);
  const Scene& scene = asked.scene.scene;
  Frame frame;
  double plan_ms = 0;
  const Ticket ticket =
      service.queue.run({.client = request.peer,
                         .frame_bytes = frame_bytes(scene) + picture_bytes(scene),
                         .watch = watch,
                         .work = [&](Engine& engine, const Watch& w) {
                           // Here, where its memory is counted: small bodies hold large
                           // pictures.
                           const Picture picture = of_picture(
                               [&] { return read_picture(request.body, scene, asked.scale); });
                           const auto start = Clock::now();
                           const Plan plan = engine.plan(scene, picture, w);
                           plan_ms = Milliseconds(Clock::now() - start).count();
                           check_cost(plan, service.config);
                           frame = engine.composite(scene, picture, plan, w);
                         }});
  const PlannedFrame planned{.asked = asked.scene,
                             .plan = frame.plan,
                             .tag = composite_tag(asked, frame.plan, request, service),
                             .plan_ms = plan_ms};
  const Attention attention(watch);
  const auto [encoded, memory] = service.frames.encoded(frame, scene, ticket);
  Answer answer;
  answer.headers = planned_fields(planned);
  answer.headers.emplace_back("Cache-Control", scene.method.max_ms ? "no-store" : "no-cache");
  answer.headers.emplace_back("ETag", planned.tag);
  for (auto& field : frame_fields(planned, {encoded, Frames::Origin::rendered}, service)) {
    answer.headers.push_back(std::move(field));
  }
  answer.shared_body = {encoded, &encoded->bytes};
  answer.held = memory;
  return answer;
}

json composite_operation() {
  json out = frame_operation();
  out["requestBody"] = {
      {"required", true},
      {"description",
       "An EXR of one part: R, G, B, linear, in the unit of this server's own files (see "
       "`scale`), and Z, the distance along each pixel's ray, km; infinite or at least 1e30 "
       "for the sky. Its size is the frame's."},
      {"content", {{"image/x-exr", {{"schema", {{"type", "string"}, {"format", "binary"}}}}}}}};
  out["parameters"] = openapi::link_parameters();
  out["parameters"].push_back(
      {{"name", "scale"},
       {"in", "query"},
       {"description",
        "What 1.0 in the picture is worth in the unit of this server's own files: 1.0 of those "
        "is 1000 cd/m^2, or the picture's whiteLuminance; with `colour: channels`, spectral "
        "radiance."},
       {"schema",
        {{"type", "number"},
         {"minimum", least_scale},
         {"maximum", most_scale},
         {"default", 1}}}});
  return out;
}

}  // namespace

Route composite_post() {
  return {"POST", "/v1/composite", "Lay the scene's air over a picture with distances",
          composite_operation, composite};
}

}  // namespace cyanometer
