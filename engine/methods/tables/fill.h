// Filling a table on the device: one invocation an entry, cut into dispatches that the pacer
// allows.
#pragma once

#include <algorithm>

#include "engine/methods/method.h"

namespace cyanometer {

struct Filling {
  const vulkan::Kernel& kernel;
  const vulkan::Specialization& constants;
  const std::vector<vulkan::Binding>& bindings;
};

/// Dispatches for the entries [0, entries), `evaluations` of the density each. `push.first` and
/// `push.end` are set to each part's.
template <class Push>
void fill_table(Tracer& tracer, const Filling& filling, int entries, std::int64_t evaluations,
                Push push) {
  for (int first = 0; first < entries; first = push.end) {
    std::int64_t fit = tracer.pacer.evaluations() / evaluations / 64 * 64;
    push.first = first;
    push.end = static_cast<int>(
        std::min<std::int64_t>(entries, first + std::max<std::int64_t>(fit, 64)));
    tracer.commands.dispatch(filling.kernel, filling.constants, filling.bindings,
                             vulkan::bytes_of(push),
                             {vulkan::groups_for(push.end - first, 64)});
    tracer.pacer.took(evaluations * (push.end - first), tracer.submit());
  }
}

/// Evaluations of the density in the column of one constituent along a ray of any kind, both
/// its parts together: 8 nodes a part, or 8 between any two nodes of a tabulated profile.
std::int64_t evaluations_per_column(const Problem& problem);

/// Constituents whose columns together stay below the drivers' limit on loops: a piece of a
/// profile is a round, whose quadrature is unrolled.
int columns_at_once(const Problem& problem);

}  // namespace cyanometer
