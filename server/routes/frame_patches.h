// The frames of a sequence as merge patches of its scene: in a list, or along a sweep. Streams
// and `cyanometer render --frames` read them alike.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace cyanometer {

/// Does some work for a frame, from 0: what is refused of its scene, or over a limit, is said
/// with pointers into what was asked.
using WithinFrame = std::function<void(int frame, const std::function<void()>& work)>;

struct FramePatches {
  int count = 0;
  std::function<nlohmann::json(int)> patch;  ///< from 0
  WithinFrame within;                        ///< the sequence
};

/// {"frames": [merge patch, ...]}, or {"frames": 120, "to": {"sun.elevation_deg": -6, ...}}:
/// numbers go linearly from what they are in the scene, and all else stays what it is there.
/// @param scene_at  pointer to the scene, where it stands beside the sequence; the first frame
///                  of a sweep is the scene itself
/// @throws SceneError with pointers into `sequence`
FramePatches read_frame_patches(const nlohmann::json& scene, const nlohmann::json& sequence,
                                const std::string& scene_at);

/// Where numbers go, by dotted path; not checked.
using SweepEnds = std::vector<std::pair<std::string, nlohmann::json>>;

/// @param at     pointer to an end, but for its path
/// @param count  a whole number from 1
/// @throws SceneError
FramePatches read_sweep(const nlohmann::json& scene, const nlohmann::json& count,
                        const SweepEnds& ends, const std::string& at,
                        const std::string& scene_at);

}  // namespace cyanometer
