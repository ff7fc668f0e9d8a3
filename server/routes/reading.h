// Reading the parts of a body that are not a scene, refused in the words in which the scene's
// own members are.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace cyanometer {

/// @throws SceneError, always
[[noreturn]] void refuse(const std::string& pointer, const nlohmann::json& given,
                         const std::string& allowed);
/// @throws SceneError, always
[[noreturn]] void miss(const std::string& pointer, const std::string& allowed);

/// @throws SceneError where it is no object or has other members
void check_members(const nlohmann::json& object, const std::string& pointer,
                   const std::vector<std::string>& known);

/// Reads a document that stands at `pointer` in the body: refusals and limits say so.
void within(const std::string& pointer, const std::function<void()>& read);

}  // namespace cyanometer
