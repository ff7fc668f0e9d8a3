// From what is thrown to what is answered.
#pragma once

#include "server/http/problem.h"
#include "server/queue/render_queue.h"

namespace cyanometer {

/// The exception in flight as a problem; what it says of the inside is logged, never sent.
/// @pre called inside a catch
HttpProblem current_problem();

/// Of which there may be thousands a second.
HttpProblem problem_of(const QueueFull& full);

}  // namespace cyanometer
