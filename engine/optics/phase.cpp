#include "engine/optics/phase.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace cyanometer {
namespace {

/// The integral of f sin over [t0, t1], f going from f0 to f1 as it is interpolated.
double segment(double t0, double t1, double f0, double f1) {
  const double length = t1 - t0;
  if (length <= 0) return 0;
  if (f0 <= 0 || f1 <= 0) {
    const double slope = (f1 - f0) / length;
    return f0 * std::cos(t0) - f1 * std::cos(t1) + slope * (std::sin(t1) - std::sin(t0));
  }
  const double rate = std::log(f1 / f0) / length;
  const auto antiderivative = [rate](double f, double t) {
    return f * (rate * std::sin(t) - std::cos(t)) / (rate * rate + 1);
  };
  return antiderivative(f1, t1) - antiderivative(f0, t0);
}

}  // namespace

double sphere_integral(const std::vector<double>& angle_rad,
                       const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = 1; i < angle_rad.size(); ++i)
    sum += segment(angle_rad[i - 1], angle_rad[i], values[i - 1], values[i]);
  return 2 * std::numbers::pi * sum;
}

std::vector<double> normalised_phase(const std::vector<double>& angle_rad,
                                     std::vector<double> values) {
  const double integral = sphere_integral(angle_rad, values);
  if (integral > 0)
    for (double& value : values) value /= integral;
  return values;
}

}  // namespace cyanometer
