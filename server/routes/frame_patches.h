// The frames of a sequence as merge patches of its scene: in a list, or along a sweep. Streams
// and `cyanometer render --frames` read them alike.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace cyanometer {

struct FramePatches {
  int count = 0;
  std::function<nlohmann::json(int)> patch;  ///< from 0
  bool listed = false;                       ///< each in the document, at /frames/0, ...

  /// Where the frame's own scene stands in the sequence; "" where it is not listed.
  std::string pointer(int frame) const {
    return listed ? "/frames/" + std::to_string(frame) : "";
  }
};

/// {"frames": [merge patch, ...]}, or {"frames": 120, "to": {"sun.elevation_deg": -6, ...}}:
/// numbers go linearly from what they are in the scene.
/// @throws SceneError with pointers into `sequence`
FramePatches read_frame_patches(const nlohmann::json& scene, const nlohmann::json& sequence);

/// Where numbers go, by dotted path; not checked.
using SweepEnds = std::vector<std::pair<std::string, nlohmann::json>>;

/// @param at     pointer to an end, but for its path
/// @param count  a whole number from 1
/// @throws SceneError
FramePatches read_sweep(const nlohmann::json& scene, const nlohmann::json& count,
                        const SweepEnds& ends, const std::string& at);

}  // namespace cyanometer
