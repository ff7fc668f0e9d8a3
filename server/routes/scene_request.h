// The scene that a request asks for, out of its body or its link, within the daemon's limits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "engine/engine.h"
#include "engine/scene/scene.h"
#include "server/config.h"
#include "server/http/message.h"

namespace cyanometer {

/// A scene with its canonical text.
struct SceneRequest {
  Scene scene;
  std::string canonical;
};

/// The body as JSON. @throws SceneError, HttpProblem 400 where it is empty, 413
nlohmann::json body_document(const Request& request);
/// The document of a link. @throws SceneError
nlohmann::json link_document(const Request& request);

SceneRequest scene_request(const Scene& scene);
/// Reads and validates. @throws SceneError
SceneRequest scene_request(const nlohmann::json& document);

/// The document with this `image.format` where it names none.
nlohmann::json with_usual_format(nlohmann::json document, std::string_view format);

/// Where the document names no `image.format`, the one the Accept header prefers.
/// @throws HttpProblem 406
nlohmann::json negotiate_format(nlohmann::json document, const Request& request);

/// Memory of the scene's frame: float planes and displayed pixels. Without a plan, of as few
/// wavelengths as one may take.
std::size_t frame_bytes(const Scene& scene, const Plan& plan = {});

/// Wavelengths and samples. @throws OverLimit
void check_scene(const Scene& scene, const Config& config);
/// Of the frame, as in frame_bytes. @throws OverLimit
void check_memory(const Scene& scene, const Plan& plan, const Config& config);
/// These and pixels, before there is a plan. @throws OverLimit
void check_frame(const Scene& scene, const Config& config);

}  // namespace cyanometer
