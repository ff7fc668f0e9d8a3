#include "engine/methods/tables/fill.h"

namespace cyanometer {

std::int64_t evaluations_per_column(const Problem& problem) {
  std::size_t pieces = 1;
  for (const Medium& medium : problem.media) {
    if (auto* table = std::get_if<TableProfile>(&medium.profile)) {
      pieces = std::max(pieces, table->altitude_km.size() + 1);
    }
  }
  return static_cast<std::int64_t>(16 * pieces);
}

int columns_at_once(const Problem& problem) {
  std::int64_t most = usual_loop_iterations / evaluations_per_column(problem);
  return static_cast<int>(std::max<std::int64_t>(most, 1));
}

}  // namespace cyanometer
