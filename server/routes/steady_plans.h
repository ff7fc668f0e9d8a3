// Plans along a stream: what was chosen for one frame is kept for the next as long as it will
// do, because a change of method between two frames is seen more easily than an error.
#pragma once

#include "server/routes/frame.h"

namespace cyanometer {

class SteadyPlans {
 public:
  SteadyPlans(Service& service, std::string client)
      : service_(service), client_(std::move(client)) {}

  /// @throws as plan_frame
  PlannedFrame next(const SceneRequest& asked, const Watch& watch);

 private:
  bool keep_method(const SceneRequest& asked, Plan& plan, const Watch& watch) const;

  Service& service_;
  std::string client_;
  std::optional<Plan> before_;
};

}  // namespace cyanometer
