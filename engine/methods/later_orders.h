// Which orders are kept, so that all later ones can be told from them
// (shaders/methods/later_orders.glsl).
#pragma once

#include <algorithm>
#include <optional>

namespace cyanometer {

/// The last orders that are traced, in chunks of as many each.
struct LaterOrders {
  static constexpr int most_chunks = 4;
  int chunks = 0;  ///< one more than the modes that are told apart; none where orders end
  int each = 1;    ///< orders of a chunk

  /// Modes lie the further apart the more orders a chunk has.
  static LaterOrders after(int orders) {
    int chunks = orders >= 24 ? most_chunks : orders >= 4 ? 3 : 2;
    return {chunks, std::max(orders / (chunks + 2), 1)};
  }
  /// Which chunk begins after an order, if one does.
  std::optional<int> begins_after(int order, int orders) const {
    int left = orders - order;
    bool begins = left > 0 && left % each == 0 && left / each <= chunks;
    return begins ? std::optional(chunks - left / each) : std::nullopt;
  }
};

}  // namespace cyanometer
