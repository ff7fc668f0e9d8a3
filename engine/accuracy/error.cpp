#include "engine/accuracy/error.h"

#include <algorithm>
#include <cmath>

namespace cyanometer {
namespace {

double median_of_positive(const std::vector<std::vector<double>>& pixels, std::size_t channel) {
  std::vector<double> positive;
  for (const auto& pixel : pixels) {
    if (pixel[channel] > 0) positive.push_back(pixel[channel]);
  }
  if (positive.empty()) return 0;
  auto middle = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 2);
  std::nth_element(positive.begin(), middle, positive.end());
  if (positive.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(positive.begin(), middle)) / 2;
}

/// The smallest value that at least the share `p` of all values does not exceed.
double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  double rank = std::ceil(p * static_cast<double>(values.size())) - 1;
  auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<double> relative_differences(const std::vector<std::vector<double>>& values,
                                         const std::vector<std::vector<double>>& reference) {
  std::size_t channels = values.empty() ? 0 : values.front().size();
  std::vector<double> differences(values.size() * channels, 0.0);
  for (std::size_t c = 0; c < channels; ++c) {
    double floor = 0.01 * median_of_positive(reference, c);
    for (std::size_t i = 0; i < values.size(); ++i) {
      double l = values[i][c], exact = reference[i][c];
      double scale = std::max(l, exact) + floor;
      differences[i * channels + c] = scale > 0 ? (l - exact) / scale : 0;
    }
  }
  return differences;
}

ErrorMeasure measure_error(const std::vector<std::vector<double>>& values,
                           const std::vector<std::vector<double>>& reference) {
  std::vector<double> d = relative_differences(values, reference);
  ErrorMeasure measure;
  if (d.empty()) return measure;
  double sum = 0, squares = 0;
  for (double& x : d) {
    sum += x;
    squares += x * x;
    x = std::abs(x);
    measure.max = std::max(measure.max, x);
  }
  double count = static_cast<double>(d.size());
  measure.bias = sum / count;
  measure.p99 = percentile(std::move(d), 0.99);
  measure.error = std::max(std::sqrt(squares / count), measure.p99 / 3);
  return measure;
}

}  // namespace cyanometer
