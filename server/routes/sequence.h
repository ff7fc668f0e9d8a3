// The frames of a stream: which scenes follow each other.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "server/config.h"
#include "server/http/message.h"
#include "server/routes/frame_patches.h"
#include "server/routes/scene_request.h"

namespace cyanometer {

struct Sequence {
  int count = 0;
  /// From 0. Does not throw for a sequence that was checked.
  std::function<SceneRequest(int)> scene;
  WithinFrame within;  ///< the request
  /// The last scene is the aim; those before it are coarser, each worth showing only where it
  /// is cheaper.
  bool refines = false;
};

/// {"scene"} with {"refine": true} or with frames as in frame_patches.h.
/// @throws SceneError with pointers into the body, OverLimit
Sequence sequence_of_body(const Request& request, const Config& config, const Watch& watch);

/// A scene as in a link, with `refine=true`, or with `frames=N` and `to.PATH=number`: numbers
/// go linearly from what they are in the scene.
/// @throws as sequence_of_body
Sequence sequence_of_link(const Request& request, const Config& config, const Watch& watch);

}  // namespace cyanometer
