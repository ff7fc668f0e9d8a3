// The least that a frame could take on this machine.
#pragma once

#include <nlohmann/json.hpp>

namespace cyanometer {

struct Floor {
  double store_ms = 0;   ///< of a pass of the device that only stores pixels
  double encode_ms = 0;  ///< of a rendered picture
  double answer_ms = 0;  ///< from one answer without a frame to the next
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Floor, store_ms, encode_ms, answer_ms)

}  // namespace cyanometer
