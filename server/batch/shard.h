// The part of a sequence that one of several processes renders.
#pragma once

#include <string>

namespace cyanometer {

/// Every `count`-th frame from `index` on: neighbours, which take about as long, are spread.
struct Shard {
  int index = 0, count = 1;

  bool holds(int frame) const { return frame % count == index; }
  /// "" of the only one, else ".3-of-16".
  std::string suffix() const;
};

/// "3/16" is the fourth of sixteen; "/16" takes its index from JOB_COMPLETION_INDEX, which
/// Kubernetes sets in the pods of an Indexed Job.
/// @throws std::invalid_argument saying what is allowed
Shard read_shard(const std::string& text);

}  // namespace cyanometer
