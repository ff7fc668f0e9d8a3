// Tabulated phase functions: log-linear in angle, linear next to a zero.
#pragma once

#include <vector>

namespace cyanometer {

/// The integral over the sphere of the function as it is interpolated. `angle_rad` ascends.
double sphere_integral(const std::vector<double>& angle_rad, const std::vector<double>& values);

/// The values divided by their integral; as they are where that is 0.
std::vector<double> normalised_phase(const std::vector<double>& angle_rad,
                                     std::vector<double> values);

}  // namespace cyanometer
