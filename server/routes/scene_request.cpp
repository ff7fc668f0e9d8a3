#include "server/routes/scene_request.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/engine.h"
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
  return parse_json(request.body);
}

nlohmann::json link_document(const Request& request) {
  return document_from_query(request.query);
}

SceneRequest scene_request(const nlohmann::json& document) {
  SceneRequest out;
  out.scene = read_scene(document);
  out.canonical = canonical(out.scene).dump();
  return out;
}

nlohmann::json negotiate_format(nlohmann::json document, const Request& request) {
  const std::string accept = request.header("accept");
  if (accept.empty() || !document.is_object() || names_format(document)) return document;
  std::vector<std::string_view> types;
  for (const auto& each : encodings()) types.push_back(each.media_type);
  const auto best = negotiated(accept, types);
  if (!document.contains("image") || document["image"].is_null()) {
    document["image"] = nlohmann::json::object();
  }
  // An image that is no object is left to be refused with the document.
  if (document["image"].is_object()) document["image"]["format"] = encodings()[best].name;
  return document;
}

std::size_t frame_bytes(const Scene& scene) {
  const auto& image = scene.image;
  // How many wavelengths `auto` takes is the plan's to say; a layer has as many channels as the
  // image.
  const std::size_t wavelengths =
      std::max<std::size_t>(scene.spectrum.wavelengths_nm.size(), 3);
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

void check_frame(const Scene& scene, const Config& config) {
  check_scene(scene, config);
  const double pixels = static_cast<double>(scene.image.width) * scene.image.height;
  if (pixels > config.max_pixels) {
    throw OverLimit("/image/width", std::to_string(scene.image.width) + " x " +
                                        std::to_string(scene.image.height) +
                                        " pixels are more than the " +
                                        std::to_string(config.max_pixels) + " of this server");
  }
  if (frame_bytes(scene) > config.frame_bytes()) {
    throw OverLimit("/image", "the frame needs " + std::to_string(frame_bytes(scene)) +
                                  " bytes, more than the " +
                                  std::to_string(config.frame_bytes()) + " of this server");
  }
}

}  // namespace cyanometer
