// GET /v1/methods, /v1/presets, /v1/limits, /v1/schema: what there is.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/scene/document.h"
#include "server/routes/answers.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json option_document(const MethodOption& option) {
  return {{"name", option.name},
          {"title", option.title},
          {"description", option.description},
          {"unit", option.unit},
          {"minimum", option.minimum},
          {"maximum", option.maximum},
          {"default", option.default_value},
          {"integer", option.integer},
          {"logarithmic", option.logarithmic}};
}

json methods_document() {
  json list = json::array();
  for (const auto& method : methods()) {
    json options = json::array();
    for (const auto& option : method.options) options.push_back(option_document(option));
    json limits = json::array();
    for (const auto& limit : method.limits) limits.push_back(limit.words);
    const json highest = method.highest_order < 0 ? json("all") : json(method.highest_order);
    list.push_back({{"name", method.name},
                    {"title", method.title},
                    {"summary", method.summary},
                    {"highest_order", highest},
                    {"limits", limits},
                    {"options", options}});
  }
  return {{"methods", list}};
}

json presets_document() {
  json list = json::array();
  for (const auto& preset : presets()) {
    list.push_back({{"name", preset.name},
                    {"title", preset.title},
                    {"source", preset.source},
                    {"scene", preset_document(preset.name)}});
  }
  return {{"presets", list}};
}

json limits_document(const Config& config) {
  return {{"pixels", config.max_pixels},
          {"wavelengths", config.max_wavelengths},
          {"samples", config.max_samples},
          {"device_s", config.max_device_s},
          {"frames", config.max_frames},
          {"directions", most_directions},
          {"body_bytes", config.body_bytes()},
          {"json_bytes", std::min(most_json_bytes, config.body_bytes())},
          {"frame_bytes", config.frame_bytes()},
          {"kernels", config.kernels},
          {"queue", config.queue},
          {"connections", config.threads},
          {"deadline_s", config.deadline_s}};
}

Route list(const std::string& path, const std::string& summary,
           std::function<json(const Service&)> document) {
  return {"GET", path, summary,
          [] {
            return json{{"responses",
                         openapi::responses(openapi::json_content({{"type", "object"}}), {})}};
          },
          [document = std::move(document)](const Request& request, Service& service) {
            const Answer answer = json_answer(document(service));
            return with_tag(answer, request, entity_tag({answer.body}));
          }};
}

}  // namespace

Route methods_list() {
  return list("/v1/methods", "The methods and their options",
              [](const Service&) { return methods_document(); });
}

Route presets_list() {
  return list("/v1/presets", "The named scenes and where their numbers come from",
              [](const Service&) { return presets_document(); });
}

Route limits_list() {
  return list("/v1/limits", "The limits of this server",
              [](const Service& service) { return limits_document(service.config); });
}

Route schema_document() {
  return list("/v1/schema", "JSON Schema of the scene document",
              [](const Service&) { return scene_schema(); });
}

}  // namespace cyanometer
