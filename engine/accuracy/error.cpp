#include "engine/accuracy/error.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace cyanometer {
namespace {

using Pixels = std::vector<std::vector<double>>;

std::size_t channels_of(const Pixels& pixels) {
  return pixels.empty() ? 0 : pixels.front().size();
}

std::vector<double> flat(const Pixels& pixels) {
  std::vector<double> values;
  values.reserve(pixels.size() * channels_of(pixels));
  for (const auto& pixel : pixels) values.insert(values.end(), pixel.begin(), pixel.end());
  return values;
}

double median_of_positive(std::span<const double> values, std::size_t channel,
                          std::size_t channels) {
  std::vector<double> positive;
  for (std::size_t i = channel; i < values.size(); i += channels) {
    if (values[i] > 0) positive.push_back(values[i]);
  }
  if (positive.empty()) return 0;
  auto middle = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 2);
  std::nth_element(positive.begin(), middle, positive.end());
  if (positive.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(positive.begin(), middle)) / 2;
}

/// (L - from) in the scale that L and its reference set.
std::vector<double> differences_from(std::span<const double> from,
                                     std::span<const double> values,
                                     std::span<const double> reference, std::size_t channels) {
  std::vector<double> differences(values.size(), 0.0);
  for (std::size_t c = 0; c < channels; ++c) {
    double floor = 0.01 * median_of_positive(reference, c, channels);
    for (std::size_t i = c; i < values.size(); i += channels) {
      double scale = std::max(values[i], reference[i]) + floor;
      differences[i] = scale > 0 ? (values[i] - from[i]) / scale : 0;
    }
  }
  return differences;
}

/// A difference as two independent estimates of it tell.
struct NoisyDifference {
  double mean, square, noise;
  NoisyDifference(double a, double b)
      : mean((a + b) / 2), square(a * b), noise(std::abs(a - b) / 2) {}
};

/// Percentiles of noisy values, with the noise's own taken out in quadrature: exact for normal
/// errors under normal noise, and nothing where there is noise alone.
double p99_of(const std::vector<NoisyDifference>& differences) {
  std::vector<double> seen, noise;
  for (const NoisyDifference& d : differences) {
    seen.push_back(std::abs(d.mean));
    noise.push_back(d.noise);
  }
  double all = percentile(std::move(seen), 0.99), chance = percentile(std::move(noise), 0.99);
  return std::sqrt(std::max(all * all - chance * chance, 0.0));
}

double error_of(const std::vector<NoisyDifference>& differences) {
  double sum = 0;
  for (const NoisyDifference& d : differences) sum += d.square;
  double rms = std::sqrt(std::max(sum, 0.0) / static_cast<double>(differences.size()));
  return std::max(rms, p99_of(differences) / 3);
}

/// The error of pixels drawn with replacement, many times over; ascending.
std::vector<double> bootstrap(const std::vector<NoisyDifference>& differences,
                              std::size_t channels) {
  constexpr int samples = 200;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> pixel(0, differences.size() / channels - 1);
  std::vector<double> errors;
  std::vector<NoisyDifference> drawn = differences;
  for (int sample = 0; sample < samples; ++sample) {
    for (std::size_t i = 0; i < drawn.size(); i += channels) {
      std::size_t from = pixel(random) * channels;
      for (std::size_t c = 0; c < channels; ++c) drawn[i + c] = differences[from + c];
    }
    errors.push_back(error_of(drawn));
  }
  std::ranges::sort(errors);
  return errors;
}

}  // namespace

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  double rank = std::ceil(p * static_cast<double>(values.size())) - 1;
  auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<double> relative_differences(std::span<const double> values,
                                         std::span<const double> reference,
                                         std::size_t channels) {
  return differences_from(reference, values, reference, channels);
}

std::vector<double> relative_differences(const Pixels& values, const Pixels& reference) {
  return relative_differences(flat(values), flat(reference), channels_of(values));
}

ErrorMeasure measure_error(std::span<const double> values, std::span<const double> reference,
                           std::size_t channels) {
  std::vector<double> d = relative_differences(values, reference, channels);
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

ErrorMeasure measure_error(const Pixels& values, const Pixels& reference) {
  return measure_error(flat(values), flat(reference), channels_of(values));
}

namespace {

/// Where walks saw no light in a channel they can't tell none from little.
bool is_blind(const std::vector<double>& reference, const std::vector<double>& values,
              std::size_t channels) {
  std::vector<double> seen(channels, 0.0), shown(channels, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    seen[i % channels] += reference[i];
    shown[i % channels] += values[i];
  }
  for (std::size_t c = 0; c < channels; ++c) {
    if (seen[c] == 0 && shown[c] > 0) return true;
  }
  return false;
}

}  // namespace

EstimatedError measure_error(const Pixels& values, const Pixels& half_a, const Pixels& half_b) {
  std::size_t channels = channels_of(values);
  std::vector<double> l = flat(values), mean = flat(mean_of(half_a, half_b)),
                      a = differences_from(flat(half_a), l, mean, channels),
                      b = differences_from(flat(half_b), l, mean, channels);
  EstimatedError estimate;
  if (a.empty()) return estimate;
  std::vector<NoisyDifference> differences;
  ErrorMeasure& measure = estimate.measure;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const NoisyDifference& d = differences.emplace_back(a[i], b[i]);
    measure.bias += d.mean / static_cast<double>(a.size());
    measure.max = std::max(measure.max, std::abs(d.mean));
  }
  measure.p99 = p99_of(differences);
  measure.error = error_of(differences);
  std::vector<double> errors = bootstrap(differences, channels);
  estimate.low = errors[errors.size() / 40];
  estimate.high = errors[errors.size() - 1 - errors.size() / 40];
  if (is_blind(mean, l, channels)) {
    estimate.low = 0;
    estimate.high = 1;
  }
  return estimate;
}

Pixels mean_of(const Pixels& a, const Pixels& b) {
  Pixels mean = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t c = 0; c < a[i].size(); ++c) mean[i][c] = (a[i][c] + b[i][c]) / 2;
  }
  return mean;
}

}  // namespace cyanometer
