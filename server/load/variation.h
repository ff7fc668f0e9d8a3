// What changes from one frame of a load to the next.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cyanometer {

/// `exposure`: the same sky by the same plan, each time a hair brighter or, in formats that
/// have no exposure, turned by a hair, so that it has not been kept. `everything` is camera,
/// sun and atmosphere at once.
enum class Variation { nothing, exposure, camera, sun, atmosphere, everything };

const std::string& name_of(Variation variation);
/// @pre one of variation_names()
Variation variation_of(const std::string& name);
const std::vector<std::string>& variation_names();

/// Scenes one after another as the frames of an animation that goes to and fro without end,
/// some 120 frames each way. No two of a motion are equal, but where nothing varies or there is
/// no air to change.
class Motion {
 public:
  /// @throws SceneError where the scene must be read, as for what moves
  Motion(const nlohmann::json& scene, Variation variation);

  nlohmann::json frame(std::size_t number) const;

 private:
  Variation variation_;
  nlohmann::json scene_;
};

}  // namespace cyanometer
