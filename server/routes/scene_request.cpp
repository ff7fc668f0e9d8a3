#include "server/routes/scene_request.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/http/accept.h"
#include "server/http/problem.h"

namespace cyanometer {
namespace {

bool names_format(const nlohmann::json& document) {
  return document.is_object() && document.contains("image") && document["image"].is_object() &&
         document["image"].contains("format") && !document["image"]["format"].is_null();
}

}  // namespace

nlohmann::json body_document(const Request& request) {
  if (request.body.empty()) {
    HttpProblem problem(400, "The body is empty; the smallest scene is {}.");
    problem.allowed = "a JSON document";
    throw problem;
  }
  if (request.body.size() > most_json_bytes) {
    HttpProblem problem(413, "The body has " + std::to_string(request.body.size()) +
                                 " bytes, more than JSON may have.");
    problem.allowed = "at most " + std::to_string(most_json_bytes) + " bytes of JSON";
    throw problem;
  }
  return parse_json(request.body);
}

nlohmann::json link_document(const Request& request) {
  return document_from_query(request.query);
}

SceneRequest scene_request(const Scene& scene) { return {scene, canonical(scene).dump()}; }

SceneRequest scene_request(const nlohmann::json& document) {
  return scene_request(read_scene(document));
}

nlohmann::json with_usual_format(nlohmann::json document, std::string_view format) {
  if (!document.is_object() || names_format(document)) return document;
  nlohmann::json& image = document["image"];
  if (image.is_null()) image = nlohmann::json::object();
  // An image that is no object is left to be refused with the document.
  if (image.is_object()) image["format"] = format;
  return document;
}

nlohmann::json negotiate_format(nlohmann::json document, const Request& request) {
  const std::string accept = request.header("accept");
  if (accept.empty() || !document.is_object() || names_format(document)) return document;
  std::vector<std::string_view> types;
  for (const auto& each : encodings()) types.push_back(each.media_type);
  return with_usual_format(std::move(document), encodings()[negotiated(accept, types)].name);
}

std::size_t frame_bytes(const Scene& scene, const Plan& plan) {
  const auto& image = scene.image;
  // How many wavelengths `auto` takes is the plan's to say; a layer has as many channels as the
  // image.
  const std::size_t wavelengths = std::max(
      {scene.spectrum.wavelengths_nm.size(), plan.wavelengths_nm.size(), std::size_t{3}});
  const std::size_t channels = image.channels == Channels::spectral ? wavelengths : 3;
  const auto& layers = image.layers;
  const std::size_t copies =
      1 + layers.transmittance + layers.inscatter + layers.ground + layers.sun;
  // How far the ground is along each ray, where that ends, and a copy of it.
  const bool varied = !std::holds_alternative<UniformSurface>(scene.planet.surface);
  const std::size_t planes =
      channels * copies + encoding(image.format).displayed + (varied ? 3 : 0);
  return planes * sizeof(float) * static_cast<std::size_t>(image.width) *
         static_cast<std::size_t>(image.height);
}

namespace {

/// Each option that multiplies the work of a pixel, with the sun's points.
void check_samples(const Scene& scene, const Config& config) {
  double samples = scene.sun.disc_samples;
  std::string counted;
  for (const auto& [name, value] : scene.method.options) {
    if (name != "view_samples" && name != "light_samples" && name != "samples_per_pixel") {
      continue;
    }
    samples *= value;
    counted = name;
  }
  if (counted.empty() || samples <= config.max_samples) return;
  std::ostringstream text;
  text.precision(12);
  text << samples << " samples of a pixel are more than the " << config.max_samples
       << " of this server";
  throw OverLimit("/method/" + counted, text.str());
}

}  // namespace

void check_scene(const Scene& scene, const Config& config) {
  const auto count = scene.spectrum.wavelengths_nm.size();
  if (count > static_cast<std::size_t>(config.max_wavelengths)) {
    throw OverLimit("/spectrum/wavelengths_nm",
                    std::to_string(count) + " wavelengths are more than the " +
                        std::to_string(config.max_wavelengths) + " of this server");
  }
  check_samples(scene, config);
}

void check_memory(const Scene& scene, const Plan& plan, const Config& config) {
  const std::size_t bytes = frame_bytes(scene, plan);
  if (bytes <= config.frame_bytes()) return;
  throw OverLimit("/image", "the frame needs " + std::to_string(bytes) +
                                " bytes, more than the " +
                                std::to_string(config.frame_bytes()) + " of this server");
}

void check_frame(const Scene& scene, const Config& config) {
  check_scene(scene, config);
  const double pixels = static_cast<double>(scene.image.width) * scene.image.height;
  if (pixels > config.max_pixels) {
    throw OverLimit("/image/width", std::to_string(scene.image.width) + " x " +
                                        std::to_string(scene.image.height) +
                                        " pixels are more than the " +
                                        std::to_string(config.max_pixels) + " of this server");
  }
  check_memory(scene, {}, config);
}

}  // namespace cyanometer
