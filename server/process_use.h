// What the daemon's process takes of its machine.
#pragma once

namespace cyanometer {

struct ProcessUse {
  double cpu_s = 0;           ///< of all its threads, since it began
  double resident_bytes = 0;  ///< that are in memory now
};

ProcessUse process_use();

}  // namespace cyanometer
