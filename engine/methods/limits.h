// Which limits of a method a scene comes near.
#pragma once

#include "engine/engine.h"
#include "engine/problem.h"

namespace cyanometer {

SceneTraits traits_of(const Problem& problem);

}  // namespace cyanometer
