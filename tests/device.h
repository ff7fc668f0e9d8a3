// The engine of a suite's tests.
#pragma once

#include "engine/engine.h"

namespace cyanometer {

/// Made once, since its kernels take seconds to compile.
inline Engine& device() {
  static Engine engine;
  return engine;
}

}  // namespace cyanometer
