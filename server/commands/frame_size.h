// A frame's size as options say it.
#pragma once

#include <string>
#include <utility>

namespace cyanometer {

/// Width and height of "1280x720". @throws CommandError
std::pair<int, int> read_frame_size(const std::string& text);

}  // namespace cyanometer
