// The scene of a composite, whose frame is as large as the picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace cyanometer {

/// What 1.0 in a picture may be worth in the unit of the frame's files.
constexpr double least_scale = 1e-12, most_scale = 1e12;

/// The document with the size of the picture, an EXR.
/// @throws SceneError where it names another; ImageError
nlohmann::json sized_as(nlohmann::json document, std::string_view picture);

/// @throws SceneError where the scene asks for what a picture of R, G and B has not
void check_composite(const Scene& scene);

}  // namespace cyanometer
