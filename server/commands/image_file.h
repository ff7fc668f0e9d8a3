// Commands that write an image: its format is the file's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/scene/scene.h"

namespace cyanometer {

/// The document with the format of the file's extension, where it names none itself; - is
/// standard output. @throws CommandError where no format has this extension
nlohmann::json document_for_file(const nlohmann::json& document, const std::string& path);
/// @throws CommandError where the scene's format is not that of the file's extension
void check_file(const Scene& scene, const std::string& path);

/// The scene of the document for the file. @throws SceneError, CommandError
Scene scene_for_file(const nlohmann::json& document, const std::string& path);

}  // namespace cyanometer
