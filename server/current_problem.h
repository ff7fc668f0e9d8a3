// From what is thrown to what is answered.
#pragma once

#include "server/http/problem.h"

namespace cyanometer {

/// The exception in flight as a problem; what it says of the inside is logged, never sent.
/// @pre called inside a catch
HttpProblem current_problem();

}  // namespace cyanometer
