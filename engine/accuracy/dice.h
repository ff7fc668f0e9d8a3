// Random numbers that are the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace cyanometer {

/// The standard's distributions differ between libraries; its engines do not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double logarithmic(double from, double to) {
    return std::exp(uniform(std::log(from), std::log(to)));
  }
  bool chance(double share) { return uniform(0, 1) < share; }
  /// 0 to count - 1.
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(uniform(0, static_cast<double>(count)));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace cyanometer
