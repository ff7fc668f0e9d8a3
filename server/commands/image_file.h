// Commands that write an image: its format is the file's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/scene/scene.h"

namespace cyanometer {

/// The scene with the format of the file's extension, where it names none itself; - is standard
/// output. @throws SceneError; CommandError where the two contradict each other
Scene scene_for_file(nlohmann::json document, const std::string& path);

}  // namespace cyanometer
