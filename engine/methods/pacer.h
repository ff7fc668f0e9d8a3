// How much work fits into one dispatch. Long dispatches hold up cancelled and urgent requests,
// and desktop drivers kill them; so work is cut by an estimate that follows what was measured.
// Cutting never changes a result: state between dispatches is carried in full.
#pragma once

#include <algorithm>
#include <cstdint>

namespace cyanometer {

/// Rounds of all its loops together that an invocation may make, with a margin: Mesa's software
/// drivers end every loop of an invocation without a word after 65,535.
inline constexpr int most_loop_iterations = 60000;
/// What work is cut to where it can be cut: rounds are counted from the source, and drivers
/// have been seen to count half as many again (a haze of three tabulated profiles).
inline constexpr int usual_loop_iterations = most_loop_iterations / 2;

class Pacer {
 public:
  /// Aims at half of the longest dispatch allowed.
  explicit Pacer(double longest_dispatch_ms) : aim_ms_(longest_dispatch_ms / 2) {}

  /// Evaluations of the optical depth (one sample of all constituents) that one dispatch may
  /// hold.
  std::int64_t evaluations() const { return static_cast<std::int64_t>(rate_ * aim_ms_); }

  /// What a dispatch took. One report moves the estimate by a factor of 3 at the most: a
  /// pipeline's first dispatch is slow, because drivers compile it then.
  void took(std::int64_t evaluations, double ms) {
    if (ms < 0.5) return;  // too short to tell
    double measured = static_cast<double>(evaluations) / ms;
    rate_ = std::clamp(measured, rate_ / 3, rate_ * 3);
    longest_ms_ = std::max(longest_ms_, ms);
  }

  double evaluations_per_ms() const { return rate_; }
  double longest_ms() const { return longest_ms_; }

 private:
  double aim_ms_;
  double rate_ = 4e4;  // evaluations a ms: a slow core
  double longest_ms_ = 0;
};

}  // namespace cyanometer
