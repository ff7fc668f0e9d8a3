// POST and GET /v1/render: scene in, image out.
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string fixed(double value) {
  std::array<char, 400> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value,
                                     std::chars_format::fixed, 3)
                           .ptr};
}

std::string options_text(const std::map<std::string, double>& options) {
  std::string out;
  for (const auto& [name, value] : options) {
    out += (out.empty() ? "" : ";") + name + "=" + shortest(value);
  }
  return out;
}

std::string frame_tag(const SceneRequest& asked, const Plan& plan, const Service& service) {
  std::string wavelengths;
  for (const double l : plan.wavelengths_nm) wavelengths += shortest(l) + ",";
  const auto device = service.queue.device();
  return entity_tag({asked.canonical, plan.method, options_text(plan.options), wavelengths,
                     version(), device.name, device.driver, device.api_version});
}

/// What an answer says without a frame.
void describe(Answer& answer, const SceneRequest& asked, const Plan& plan, bool link) {
  const bool timed = asked.scene.method.max_ms.has_value();
  Fields& headers = answer.headers;
  headers.emplace_back("Content-Type", encoding(asked.scene.image.format).media_type);
  headers.emplace_back("Cache-Control", timed ? "no-store" : link ? "max-age=300" : "no-cache");
  if (link) headers.emplace_back("Vary", "Accept");
  headers.emplace_back("Cyanometer-Method", plan.method);
  headers.emplace_back("Cyanometer-Options", options_text(plan.options));
  headers.emplace_back("Cyanometer-Error", shortest(plan.expected_error));
  headers.emplace_back("Cyanometer-Met", plan.met ? "true" : "false");
  headers.emplace_back("Cyanometer-Atmosphere", atmosphere_key(asked.scene));
}

std::string server_timing(const std::vector<std::pair<std::string, double>>& stages,
                          Service& service) {
  std::string out;
  for (const auto& [name, ms] : stages) {
    service.metrics.stage(name, ms / 1000);
    out += (out.empty() ? "" : ", ") + name + ";dur=" + fixed(ms);
  }
  return out;
}

Answer render(const SceneRequest& asked, const Request& request, Service& service, bool link,
              const Watch& watch) {
  Frame frame;
  const Ticket ticket = service.queue.run(
      {.client = request.peer,
       .frame_bytes = frame_bytes(asked.scene),
       .watch = watch,
       .work = [&](Engine& engine, const Watch& w) { frame = engine.render(asked.scene, w); }});
  Answer answer;
  const auto start = Clock::now();
  answer.body = encode(frame, asked.scene);
  const double encode_ms = ms_since(start);
  describe(answer, asked, frame.plan, link);
  answer.headers.emplace_back("ETag", frame_tag(asked, frame.plan, service));
  answer.headers.emplace_back("Cyanometer-Exposure", shortest(frame.exposure_ev));
  answer.headers.emplace_back("Server-Timing", server_timing({{"queue", ticket.queued_ms},
                                                              {"prepare", frame.prepare_ms},
                                                              {"render", frame.render_ms},
                                                              {"encode", encode_ms}},
                                                             service));
  return answer;
}

/// The answer that needs no frame: 304 for the frame the client has, or a HEAD.
std::optional<Answer> without_frame(const SceneRequest& asked, const Request& request,
                                    Service& service, const Watch& watch) {
  const bool head = request.method == "HEAD";
  if (!head && request.header("if-none-match").empty()) return std::nullopt;
  const Plan plan = service.plans.get(asked.scene, asked.canonical, request.peer, watch);
  const std::string tag = frame_tag(asked, plan, service);
  if (!head && !matches(request, tag)) return std::nullopt;
  Answer answer;
  describe(answer, asked, plan, true);
  answer.length_known = false;
  return with_tag(answer, request, tag);
}

SceneRequest frame_request(const json& document, const Request& request,
                           const Service& service) {
  const auto asked = scene_request(negotiate_format(document, request));
  check_frame(asked.scene, service.config);
  return asked;
}

json operation() {
  json content;
  for (const auto& each : encodings()) {
    content[std::string(each.media_type)] = {{"schema", json::object()}};
  }
  json responses = openapi::responses(content, {400, 406, 408, 411, 413, 415, 422, 503, 504});
  openapi::add_header(responses, "ETag", "Over scene, plan, version and device.");
  openapi::add_header(responses, "Server-Timing", "queue, prepare, render, encode; dur in ms.");
  openapi::add_header(responses, "Cyanometer-Method", "The method that was used.");
  openapi::add_header(responses, "Cyanometer-Options", "Its options: name=value;...");
  openapi::add_header(responses, "Cyanometer-Error", "A bound that holds in 95 % of frames.");
  openapi::add_header(responses, "Cyanometer-Met", "false where the request could not be met.");
  openapi::add_header(responses, "Cyanometer-Exposure", "The exposure used, in stops.");
  openapi::add_header(responses, "Cyanometer-Atmosphere", "Equal keys share tables.");
  return {{"responses", responses}};
}

}  // namespace

Route render_post() {
  return {"POST", "/v1/render", "Render a scene",
          [] {
            json out = operation();
            out["requestBody"] = openapi::json_body(openapi::scene_schema_reference());
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            const auto asked = frame_request(body_document(request), request, service);
            return render(asked, request, service, false, watch);
          }};
}

Route render_link() {
  return {"GET", "/v1/render", "Render the scene that a link describes",
          [] {
            json out = operation();
            out["parameters"] = openapi::link_parameters();
            out["responses"]["304"] = {{"description", "The frame is the one the client has."}};
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            const auto asked = frame_request(link_document(request), request, service);
            if (auto answer = without_frame(asked, request, service, watch)) return *answer;
            return render(asked, request, service, true, watch);
          }};
}

}  // namespace cyanometer
