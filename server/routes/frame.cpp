#include "server/routes/frame.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/surface/surface_pass.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"

namespace cyanometer {
namespace {

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

/// RFC 9211.
std::string cache_status(Frames::Origin origin) {
  const std::string name = "cyanometer";
  if (origin == Frames::Origin::kept) return name + "; hit";
  return name + (origin == Frames::Origin::joined ? "; fwd=miss; collapsed" : "; fwd=miss");
}

std::string server_timing(const PlannedFrame& planned, const Frames::Got& got,
                          Service& service) {
  const EncodedFrame& frame = *got.frame;
  const bool kept = got.origin == Frames::Origin::kept;
  std::string out;
  const auto add = [&](const std::string& name, double ms) {
    if (got.origin == Frames::Origin::rendered) service.metrics.stage(name, ms / 1000);
    out += (out.empty() ? "" : ", ") + name + ";dur=" + fixed(ms);
  };
  add("queue", planned.queue_ms + (kept ? 0 : frame.queue_ms));
  add("prepare", planned.plan_ms + (kept ? 0 : frame.prepare_ms));
  add("render", kept ? 0 : frame.render_ms);
  add("encode", kept ? 0 : frame.encode_ms);
  return out;
}

}  // namespace

std::string shortest(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

void check_cost(const Plan& plan, const Config& config) {
  const double seconds = plan.expected_ms / 1000;
  if (seconds <= config.max_device_s) return;
  throw OverLimit("/method", "the frame is expected to take " + fixed(seconds) +
                                 " s of the device, more than the " +
                                 shortest(config.max_device_s) + " s of this server");
}

std::string frame_tag(const SceneRequest& asked, const Plan& plan, const Service& service) {
  std::string wavelengths;
  for (const double l : plan.wavelengths_nm) wavelengths += shortest(l) + ",";
  const auto device = service.queue.device();
  return entity_tag({asked.canonical, ground_revision(asked.scene), plan.method,
                     options_text(plan.options), wavelengths, version(), device.name,
                     device.driver, device.api_version});
}

PlannedFrame plan_frame(const SceneRequest& asked, const std::string& client, Service& service,
                        const Watch& watch) {
  const auto planned = service.plans.get(asked.scene, client, watch);
  check_cost(planned.plan, service.config);
  return {.asked = asked,
          .plan = planned.plan,
          .tag = frame_tag(asked, planned.plan, service),
          .plan_ms = planned.ms,
          .queue_ms = planned.queue_ms,
          .place = planned.place};
}

Frames::Got get_frame(const PlannedFrame& planned, const std::string& client, Service& service,
                      const Watch& watch, bool keep, const std::function<void()>& rendered) {
  const Scene& scene = planned.asked.scene;
  return service.frames.get({.scene = scene,
                             .plan = planned.plan,
                             .tag = planned.tag,
                             .client = client,
                             .frame_bytes = frame_bytes(scene, planned.plan),
                             .place = planned.place,
                             .keep = keep && !scene.method.max_ms,
                             .rendered = rendered},
                            watch);
}

Fields planned_fields(const PlannedFrame& planned) {
  const Scene& scene = planned.asked.scene;
  const Plan& plan = planned.plan;
  return {{"Content-Type", std::string(encoding(scene.image.format).media_type)},
          {"Cyanometer-Method", plan.method},
          {"Cyanometer-Options", options_text(plan.options)},
          {"Cyanometer-Error", shortest(plan.expected_error)},
          {"Cyanometer-Met", plan.met ? "true" : "false"},
          {"Cyanometer-Atmosphere", atmosphere_key(scene)}};
}

Fields frame_fields(const PlannedFrame& planned, const Frames::Got& got, Service& service) {
  return {{"Cyanometer-Exposure", shortest(got.frame->exposure_ev)},
          {"Server-Timing", server_timing(planned, got, service)},
          {"Cache-Status", cache_status(got.origin)}};
}

nlohmann::json frame_operation() {
  nlohmann::json content;
  for (const auto& each : encodings()) {
    content[std::string(each.media_type)] = {{"schema", nlohmann::json::object()}};
  }
  nlohmann::json responses = openapi::responses(content, {406, 411, 422, 429, 504});
  openapi::add_header(
      responses, "Cache-Status",
      "RFC 9211: kept (hit), or rendered, where `collapsed` for another's request.");
  openapi::add_header(responses, "ETag",
                      "Over scene, the files of its maps, plan, version and device.");
  openapi::add_header(responses, "Server-Timing", "queue, prepare, render, encode; dur in ms.");
  openapi::add_header(responses, "Cyanometer-Method", "The method that was used.");
  openapi::add_header(responses, "Cyanometer-Options", "Its options: name=value;...");
  openapi::add_header(responses, "Cyanometer-Error",
                      "A bound meant to hold in 95 % of frames.");
  openapi::add_header(responses, "Cyanometer-Met", "false where the request could not be met.");
  openapi::add_header(responses, "Cyanometer-Exposure", "The exposure used, in stops.");
  openapi::add_header(responses, "Cyanometer-Atmosphere", "Equal keys share tables.");
  return {{"responses", responses}};
}

}  // namespace cyanometer
