// One frame for a request: its plan within the limits, its tag, itself, and what is said of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/http/message.h"
#include "server/queue/frames.h"
#include "server/queue/plans.h"
#include "server/routes/scene_request.h"
#include "server/service.h"

namespace cyanometer {

struct PlannedFrame {
  SceneRequest asked;
  Plan plan;
  std::string tag;  ///< over scene, the files of its maps, plan, version and device
  double plan_ms = 0;
  double queue_ms = 0;              ///< waited for the plan
  std::optional<Place> place = {};  ///< where that was
};

/// @throws OverLimit also where the frame is expected to take too long, and as RenderQueue::run
PlannedFrame plan_frame(const SceneRequest& asked, const std::string& client, Service& service,
                        const Watch& watch);

/// @throws OverLimit where a frame is expected to take too long
void check_cost(const Plan& plan, const Config& config);

/// The tag of a scene's frame by a plan.
std::string frame_tag(const SceneRequest& asked, const Plan& plan, const Service& service);

/// @param keep  for requests to come, where there is room
/// @param rendered  as in Frames::Order
/// @throws as RenderQueue::run
Frames::Got get_frame(
    const PlannedFrame& planned, const std::string& client, Service& service,
    const Watch& watch, bool keep, const std::function<void()>& rendered = [] {});

/// What is said of a frame before it is there: its type, method, options, error.
Fields planned_fields(const PlannedFrame& planned);
/// What is said of it then: exposure, timing, where it came from. Counts the stages.
Fields frame_fields(const PlannedFrame& planned, const Frames::Got& got, Service& service);

/// The OpenAPI operation of a route that answers an image: its responses.
nlohmann::json frame_operation();

/// A number as short as it reads back.
std::string shortest(double value);

}  // namespace cyanometer
