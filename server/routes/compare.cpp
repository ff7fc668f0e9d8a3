// POST /v1/compare: two scenes, or a picture and a scene, against each other.
#include <nlohmann/json.hpp>

#include "engine/accuracy/comparison.h"
#include "engine/accuracy/error_picture.h"
#include "engine/accuracy/judgement.h"
#include "engine/scene/document.h"
#include "server/http/accept.h"
#include "server/http/problem.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/reading.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Bytes a pixel that the figures are computed with: both frames' three channels in double, and
/// their differences.
constexpr std::size_t bytes_per_pixel = 3 * 3 * sizeof(double);

std::size_t working_bytes(const Scene& scene) {
  return bytes_per_pixel * static_cast<std::size_t>(scene.image.width) *
         static_cast<std::size_t>(scene.image.height);
}

bool wants_picture(const Request& request) {
  return negotiated(request.header("accept"), {"application/json", "image/png"}) == 1;
}

Answer picture_answer(std::string png) {
  return {.headers = {{"Content-Type", "image/png"},
                      {"Cache-Control", "no-cache"},
                      {"Vary", "Accept"}},
          .body = std::move(png)};
}

Answer figures_answer(const Comparison& comparison) {
  Answer answer = json_answer(comparison_document(comparison));
  answer.headers.emplace_back("Vary", "Accept");
  return answer;
}

Answer compare_scenes(const Request& request, Service& service, bool picture) {
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const auto asked = read_compare_request(body_document(request));
  within("/a", [&] { check_frame(asked.a, service.config); });
  within("/b", [&] { check_frame(asked.b, service.config); });
  FramePair frames;
  const Ticket ticket = service.queue.run(
      {.client = request.peer,
       .frame_bytes = frame_bytes(asked.a) + frame_bytes(asked.b) + working_bytes(asked.b),
       .watch = watch,
       .work = [&](Engine& engine, const Watch& w) {
         frames = render_pair(engine, asked, w);
       }});
  if (!picture) return figures_answer(compare(frames, watch));
  return picture_answer(error_picture(error_map(frames), frames.b.width, frames.b.height));
}

ExrImage read_body(const Request& request, const Scene& scene) {
  try {
    return read_frame(request.body, scene);
  } catch (const ImageError& error) {
    HttpProblem problem(400, error.what());
    problem.allowed = "an EXR with R, G and B of " + std::to_string(scene.image.width) + " x " +
                      std::to_string(scene.image.height) + " pixels";
    throw problem;
  }
}

Answer judge_picture(const Request& request, Service& service, bool picture) {
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const auto asked = scene_request(link_document(request));
  check_frame(asked.scene, service.config);
  Comparison figures;
  std::vector<float> map;
  const Ticket ticket = service.queue.run(
      {.client = request.peer,
       .frame_bytes = 2 * frame_bytes(asked.scene) + working_bytes(asked.scene),
       .watch = watch,
       .work = [&](Engine& engine, const Watch& w) {
         // Here, where its memory is counted: small bodies hold large pictures.
         const ExrImage image = read_body(request, asked.scene);
         if (picture) {
           map = judged_map(engine, asked.scene, image, w);
         } else {
           figures = judge(engine, asked.scene, image, {}, w);
         }
       }});
  if (!picture) return figures_answer(figures);
  const Image& size = asked.scene.image;
  return picture_answer(error_picture(map, size.width, size.height));
}

Answer compare_request(const Request& request, Service& service) {
  const bool picture = wants_picture(request);
  const bool judges = !request.query.empty() || is_exr(request.body);
  return judges ? judge_picture(request, service, picture)
                : compare_scenes(request, service, picture);
}

json compare_operation() {
  const auto number = [](const char* description) {
    return json{{"type", "number"}, {"description", description}};
  };
  const json scene = openapi::scene_schema_reference();
  json body = openapi::json_body({{"type", "object"},
                                  {"required", {"a", "b"}},
                                  {"properties", {{"a", scene}, {"b", scene}}},
                                  {"additionalProperties", false}});
  body["content"]["image/x-exr"] = {{"schema", {{"type", "string"}, {"format", "binary"}}}};
  body["description"] =
      "Two scenes; or, with a scene as the query, an EXR (R, G, B) of its frame's size and "
      "unit "
      "to be judged against its converged solution.";
  const json answer{
      {"type", "object"},
      {"properties",
       {{"error", number("max(rms d, p99 |d| / 3)")},
        {"bias", number("The mean of d.")},
        {"p99", number("Of |d|.")},
        {"max", number("Of |d|.")},
        {"ciede2000_p99", number("Of displayed pixels, with the exposure of b.")},
        {"banding", number("The share of pixels beside contours that b does not have.")},
        {"error_95",
         {{"type", "array"},
          {"items", {{"type", "number"}}},
          {"description", "Of an EXR: the interval of its error, which is an estimate."}}}}}};
  json content = openapi::json_content(answer);
  content["image/png"] = {{"schema", json::object()}};
  return {{"requestBody", body},
          {"parameters", openapi::link_parameters()},
          {"responses", openapi::responses(content, {406, 411, 422, 429, 504})}};
}

}  // namespace

Route compare_post() {
  return {"POST", "/v1/compare", "How much two scenes, or a picture and a scene, differ",
          compare_operation, compare_request};
}

}  // namespace cyanometer
