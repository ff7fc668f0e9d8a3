#include "server/commands/frame_size.h"

#include <cstdio>

#include "server/commands/command.h"

namespace cyanometer {

std::pair<int, int> read_frame_size(const std::string& text) {
  int width = 0, height = 0, end = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &end) != 2 ||
      end != static_cast<int>(text.size()) || width < 1 || height < 1) {
    throw CommandError(exit_refused, "a size is said as 1280x720, not as " + text);
  }
  return {width, height};
}

}  // namespace cyanometer
