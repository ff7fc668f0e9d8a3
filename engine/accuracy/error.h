// The contract's measure of how wrong a frame is.
#pragma once

#include <span>
#include <vector>

namespace cyanometer {

struct ErrorMeasure {
  double error = 0;  ///< max(rms of d, 99th percentile of |d| / 3)
  double bias = 0;   ///< mean of d
  double p99 = 0;    ///< of |d|
  double max = 0;    ///< of |d|
};

/// d = (L - L_ref) / (max(L, L_ref) + 0.01 M_c) over pixels and channels, M_c the median of the
/// positive L_ref of channel c; 0 where a channel is 0 in both everywhere.
/// @param values, reference  [pixel][channel], of the same shape: the pixels that meet air or
/// ground
ErrorMeasure measure_error(const std::vector<std::vector<double>>& values,
                           const std::vector<std::vector<double>>& reference);

/// d of each pixel and channel, by the same rule; [pixel * channels + channel].
std::vector<double> relative_differences(const std::vector<std::vector<double>>& values,
                                         const std::vector<std::vector<double>>& reference);

/// The same two of frames, which are too large for a vector a pixel: [pixel * channels +
/// channel].
ErrorMeasure measure_error(std::span<const double> values, std::span<const double> reference,
                           std::size_t channels);
std::vector<double> relative_differences(std::span<const double> values,
                                         std::span<const double> reference,
                                         std::size_t channels);

/// The smallest value that at least the share `p` of all values does not exceed; 0 of none.
double percentile(std::vector<double> values, double p);

/// An error measured against a reference that is itself noisy, with its 95 % interval.
struct EstimatedError {
  ErrorMeasure measure;
  double low = 0, high = 0;
};

/// The same measure against a solution known by two independent, equally noisy estimates A and
/// B: d_A d_B has the expectation d^2, so that the reference's noise does not enter the rms;
/// from the percentile of |d_A + d_B| / 2 that of |d_A - d_B| / 2, which is noise alone, is
/// taken out in quadrature; the maximum has it. The interval is of 200 bootstrap samples over
/// pixels, of which it holds both the choice and the noise; 0 to 1 where both estimates are
/// black in a channel that shows something.
EstimatedError measure_error(const std::vector<std::vector<double>>& values,
                             const std::vector<std::vector<double>>& half_a,
                             const std::vector<std::vector<double>>& half_b);

/// The mean of the two.
std::vector<std::vector<double>> mean_of(const std::vector<std::vector<double>>& a,
                                         const std::vector<std::vector<double>>& b);

}  // namespace cyanometer
