// The scene that a request asks for, out of its body or its link, within the daemon's limits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/scene/scene.h"
#include "server/config.h"
#include "server/http/message.h"

namespace cyanometer {

/// A scene with its canonical text.
struct SceneRequest {
  Scene scene;
  std::string canonical;
};

/// The body as JSON. @throws SceneError, HttpProblem 400 where it is empty
nlohmann::json body_document(const Request& request);
/// The document of a link. @throws SceneError
nlohmann::json link_document(const Request& request);

/// Reads and validates. @throws SceneError
SceneRequest scene_request(const nlohmann::json& document);

/// Where the document names no `image.format`, the one the Accept header prefers.
/// @throws HttpProblem 406
nlohmann::json negotiate_format(nlohmann::json document, const Request& request);

/// Memory of the scene's frame: float planes and displayed pixels.
std::size_t frame_bytes(const Scene& scene);

/// Wavelengths and samples. @throws OverLimit
void check_scene(const Scene& scene, const Config& config);
/// These, pixels and memory. @throws OverLimit
void check_frame(const Scene& scene, const Config& config);

}  // namespace cyanometer
