// The least that a frame could take on this machine.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cyanometer {

/// A frame that sees neither planet nor air, the least that the engine can be asked for: black
/// pixels are stored and, in formats that show them, displayed, by the passes of any frame.
nlohmann::json unlit_scene(int width, int height, const std::string& format);

struct Floor {
  double store_ms = 0;   ///< of the device, for a frame of unlit_scene
  double encode_ms = 0;  ///< of a rendered picture
  double answer_ms = 0;  ///< from one answer without a frame to the next
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Floor, store_ms, encode_ms, answer_ms)

}  // namespace cyanometer
