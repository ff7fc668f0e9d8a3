#include "engine/optics/mie.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "engine/attention.h"
#include "engine/optics/phase.h"

namespace cyanometer {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// Logarithmic derivatives D_n of psi at z for n = 0..count, by downward recurrence [B&H
/// eq. 4.89]. It forgets its start only above |z|, where D_n grows; for real z the transition
/// takes some |z|^(1/3) orders, and an error that is left there stays.
std::vector<Complex> logarithmic_derivatives(Complex z, std::size_t count) {
  const double beyond_transition = std::abs(z) + 8 * std::cbrt(std::abs(z)) + 16;
  const auto start = std::max(count + 16, static_cast<std::size_t>(beyond_transition));
  std::vector<Complex> d(start + 1);
  for (std::size_t n = start; n > 0; --n) {
    const Complex ratio = static_cast<double>(n) / z;
    d[n - 1] = ratio - 1.0 / (d[n] + ratio);
  }
  d.resize(count + 1);
  return d;
}

/// The first terms of the expansion in powers of x [B&H section 5.1], where the recurrences of
/// psi would lose digits; relative errors are of the order of x^4.
MieSeries small_sphere_series(double x, Complex m) {
  const Complex m2 = m * m, i(0, 1);
  const Complex polarisability = (m2 - 1.0) / (m2 + 2.0);
  const double x3 = x * x * x, x5 = x3 * x * x;
  const Complex a1 = -i * (2 * x3 / 3) * polarisability -
                     i * (2 * x5 / 5) * polarisability * (m2 - 2.0) / (m2 + 2.0) +
                     4 * x3 * x3 / 9 * polarisability * polarisability;
  const Complex b1 = -i * (x5 / 45) * (m2 - 1.0);
  const Complex a2 = -i * (x5 / 15) * (m2 - 1.0) / (2.0 * m2 + 3.0);
  return {x, {a1, a2}, {b1, 0}};
}

}  // namespace

MieSeries mie_series(double x, Complex m) {
  if (m == 1.0) return {x, {0}, {0}};  // there is no sphere, and rounding must not leave one
  if (x < 0.003) return small_sphere_series(x, m);
  const auto count = static_cast<std::size_t>(x + 4 * std::cbrt(x) + 2);
  const auto d = logarithmic_derivatives(m * x, count);
  MieSeries series{x, {}, {}};
  double psi_before = std::cos(x), psi = std::sin(x);  // orders n - 2 and n - 1 [B&H eq. 4.86]
  double chi_before = -std::sin(x), chi = std::cos(x);
  for (std::size_t order = 1; order <= count; ++order) {
    const auto n = static_cast<double>(order);
    const double psi_n = (2 * n - 1) / x * psi - psi_before;
    const double chi_n = (2 * n - 1) / x * chi - chi_before;
    const Complex xi_n(psi_n, -chi_n), xi(psi, -chi);
    const auto coefficient = [&](Complex factor) {  // [B&H eq. 4.88]
      return ((factor + n / x) * psi_n - psi) / ((factor + n / x) * xi_n - xi);
    };
    series.a.push_back(coefficient(d[order] / m));
    series.b.push_back(coefficient(d[order] * m));
    psi_before = std::exchange(psi, psi_n);
    chi_before = std::exchange(chi, chi_n);
  }
  return series;
}

double extinction_efficiency(const MieSeries& s) {  // [B&H eq. 4.62]
  double sum = 0;
  for (std::size_t n = 1; n <= s.a.size(); ++n)
    sum += static_cast<double>(2 * n + 1) * (s.a[n - 1] + s.b[n - 1]).real();
  return 2 / (s.size_parameter * s.size_parameter) * sum;
}

double scattering_efficiency(const MieSeries& s) {  // [B&H eq. 4.61]
  double sum = 0;
  for (std::size_t n = 1; n <= s.a.size(); ++n)
    sum += static_cast<double>(2 * n + 1) * (std::norm(s.a[n - 1]) + std::norm(s.b[n - 1]));
  return 2 / (s.size_parameter * s.size_parameter) * sum;
}

double asymmetry(const MieSeries& s) {  // [B&H section 4.5]
  double sum = 0;
  for (std::size_t order = 1; order <= s.a.size(); ++order) {
    const auto n = static_cast<double>(order);
    const Complex a = s.a[order - 1], b = s.b[order - 1];
    sum += (2 * n + 1) / (n * (n + 1)) * (a * std::conj(b)).real();
    if (order < s.a.size()) {
      const Complex neighbours = a * std::conj(s.a[order]) + b * std::conj(s.b[order]);
      sum += n * (n + 2) / (n + 1) * neighbours.real();
    }
  }
  return 4 / (s.size_parameter * s.size_parameter) * sum / scattering_efficiency(s);
}

std::vector<double> scattered_intensity(const MieSeries& s,
                                        const std::vector<double>& cosines) {
  // Sums P = S_1 + S_2 and M = S_1 - S_2 over all angles at once, order by order; pi_n and
  // tau_n by upward recurrence [B&H eqs. 4.47 and 4.74].
  const std::size_t count = cosines.size();
  std::vector<double> p_re(count), p_im(count), m_re(count), m_im(count);
  std::vector<double> pi_before(count, 0), pi_n(count, 1);
  for (std::size_t order = 1; order <= s.a.size(); ++order) {
    const auto n = static_cast<double>(order);
    const double weight = (2 * n + 1) / (n * (n + 1));
    const Complex sum = weight * (s.a[order - 1] + s.b[order - 1]);
    const Complex difference = weight * (s.a[order - 1] - s.b[order - 1]);
    const double sr = sum.real(), si = sum.imag(), dr = difference.real(),
                 di = difference.imag();
    const double up = (2 * n + 1) / n, down = (n + 1) / n;
    for (std::size_t j = 0; j < count; ++j) {
      const double mu = cosines[j], pi_j = pi_n[j], before = pi_before[j];
      const double tau = n * mu * pi_j - (n + 1) * before;
      p_re[j] += sr * (pi_j + tau);
      p_im[j] += si * (pi_j + tau);
      m_re[j] += dr * (pi_j - tau);
      m_im[j] += di * (pi_j - tau);
      pi_before[j] = pi_j;
      pi_n[j] = up * mu * pi_j - down * before;
    }
  }
  std::vector<double> intensity(count);
  for (std::size_t j = 0; j < count; ++j)
    intensity[j] =
        0.25 * (p_re[j] * p_re[j] + p_im[j] * p_im[j] + m_re[j] * m_re[j] + m_im[j] * m_im[j]);
  return intensity;
}

namespace {

constexpr double largest_size_parameter = 5000;

/// One size parameter, shared by all wavelengths.
struct Sphere {
  double extinction = 0, scattering = 0;  ///< efficiencies
  std::vector<double> phase;              ///< 1/sr at `mie_angles_rad`
};

Sphere solve(double size_parameter, Complex index) {
  static const std::vector<double> cosines = [] {
    std::vector<double> c;
    for (double angle : mie_angles_rad()) c.push_back(std::cos(angle));
    return c;
  }();
  const MieSeries series = mie_series(std::min(size_parameter, largest_size_parameter), index);
  Sphere sphere{extinction_efficiency(series), scattering_efficiency(series),
                scattered_intensity(series, cosines)};
  const double x = series.size_parameter;
  const double sum = pi * x * x * sphere.scattering;
  for (double& value : sphere.phase) value = sum > 0 ? value / sum : 0;
  return sphere;
}

/// Natural log of how much radius e^u (um) matters at a wavelength, up to a constant: number
/// density of u, times area, times an efficiency that grows as x^4 and saturates, times x^2 for
/// the height of the forward peak of large spheres.
double log_importance(const MieSpheres& s, double u, double wavelength_um) {
  const double deviation = (u - std::log(s.radius_um)) / std::log(s.geometric_sigma);
  const double log_x = u + std::log(2 * pi / wavelength_um);
  return -0.5 * deviation * deviation + 2 * u + std::min(0.0, 4 * log_x) +
         2 * std::clamp(log_x, 0.0, std::log(largest_size_parameter));
}

struct Range {
  double first, peak, last;
};

/// Logarithms of the size parameters that matter at a wavelength to some 1e-7, and the one that
/// matters most.
Range important_sizes(const MieSpheres& s, double wavelength_um) {
  constexpr double negligible = 16;  // e^-16 = 1e-7
  const double deviation = std::log(s.geometric_sigma), middle = std::log(s.radius_um);
  const double to_log_x = std::log(2 * pi / wavelength_um);
  // With weights up to r^6 the peak lies within 6 deviation^2 of the median.
  const double below = middle - 7 * deviation;
  const double above = middle + 6 * deviation * deviation + 7 * deviation;
  constexpr int samples = 400;
  std::vector<double> importance;
  const auto u = [&](int i) {
    return std::lerp(below, above, static_cast<double>(i) / samples);
  };
  for (int i = 0; i <= samples; ++i)
    importance.push_back(log_importance(s, u(i), wavelength_um));
  const auto peak = std::ranges::max_element(importance);
  const auto matters = [&](double value) { return value > *peak - negligible; };
  const auto index = [&](auto at) { return static_cast<int>(at - importance.begin()); };
  const int first = index(std::ranges::find_if(importance, matters));
  const int last = index(std::find_if(importance.rbegin(), importance.rend(), matters).base());
  return {u(first - 1) + to_log_x, u(index(peak)) + to_log_x, u(last) + to_log_x};
}

/// Size parameters are those whose natural logarithm is a whole number of these steps, so that
/// wavelengths, distributions and requests share spheres that were solved.
constexpr double finest_step = 1.0 / 4096;
const int largest_index = static_cast<int>(std::log(largest_size_parameter) / finest_step);

/// The spheres solved so far; those of the latest few refractive indices are kept.
class SolvedSpheres {
 public:
  /// Of log size parameter i * finest_step. Looks up before it solves one.
  static std::shared_ptr<const Sphere> at(Complex refractive_index, int i) {
    {
      const std::lock_guard lock(mutex);
      const auto& spheres = of(refractive_index).spheres_;
      const auto found = spheres.find(i);
      if (found != spheres.end()) return found->second;
    }
    look_up();
    auto sphere =
        std::make_shared<const Sphere>(solve(std::exp(i * finest_step), refractive_index));
    const std::lock_guard lock(mutex);
    auto& spheres = of(refractive_index).spheres_;
    constexpr std::size_t most = 8192;  // of 2 kB
    if (spheres.size() > most) spheres.clear();
    spheres.emplace(i, sphere);
    return sphere;
  }

  explicit SolvedSpheres(Complex index) : index_(index) {}

 private:
  /// @pre the mutex is locked
  static SolvedSpheres& of(Complex refractive_index) {
    static std::deque<SolvedSpheres> latest;
    const auto found = std::ranges::find(latest, refractive_index, &SolvedSpheres::index_);
    if (found != latest.end())
      std::rotate(latest.begin(), found, found + 1);
    else
      latest.emplace_front(refractive_index);
    constexpr std::size_t kept = 4;
    if (latest.size() > kept) latest.pop_back();
    return latest.front();
  }

  static inline std::mutex mutex;
  Complex index_;
  std::unordered_map<int, std::shared_ptr<const Sphere>> spheres_;
};

/// Sums over spheres; cross-sections in um^2 and the phase function weighted by scattering.
struct Sums {
  double extinction = 0, scattering = 0;
  std::vector<double> phase = std::vector<double>(mie_angles_rad().size());

  void add(const Sphere& sphere, double area_um2) {
    extinction += area_um2 * sphere.extinction;
    scattering += area_um2 * sphere.scattering;
    for (std::size_t j = 0; j < phase.size(); ++j)
      phase[j] += area_um2 * sphere.scattering * sphere.phase[j];
  }
};

/// Steps fine enough for the distribution and for the interference between light through a
/// sphere and light around it, as far as a bounded time allows; a power of two of the finest.
/// Of a bell's curve steps of one deviation give the area to 1e-8: none is wider, and narrow
/// distributions take few.
int stride_for(const MieSpheres& s, const Range& sizes) {
  constexpr double most_terms = 1.5e5;  // of all series together
  const double largest = std::exp(std::min(sizes.last, std::log(largest_size_parameter)));
  const double deviation = std::log(s.geometric_sigma);
  const double step = std::min(
      std::max(std::min(deviation / 4, 0.4 / std::exp(sizes.peak)), largest / most_terms),
      deviation);
  return static_cast<int>(
      std::bit_floor(static_cast<unsigned>(std::max(step / finest_step, 1.0))));
}

Sums integrate_sizes(const MieSpheres& s, Complex index, double wavelength_um) {
  const Range sizes = important_sizes(s, wavelength_um);
  const int stride = stride_for(s, sizes);
  const auto on_grid = [&](double log_x) {
    return static_cast<int>(std::floor(log_x / (stride * finest_step))) * stride;
  };
  const double deviation = std::log(s.geometric_sigma);
  const double density = stride * finest_step / (deviation * std::sqrt(2 * pi));
  Sums sums;
  const int last = on_grid(sizes.last) + stride;
  for (int i = on_grid(sizes.first); i <= last; i += stride) {
    const double radius = std::exp(i * finest_step) * wavelength_um / (2 * pi);
    const double z = std::log(radius / s.radius_um) / deviation;
    sums.add(*SolvedSpheres::at(index, std::min(i, largest_index)),
             density * std::exp(-0.5 * z * z) * pi * radius * radius);
  }
  return sums;
}

Sums one_size(const MieSpheres& s, Complex index, double wavelength_um) {
  Sums sums;
  sums.add(solve(2 * pi * s.radius_um / wavelength_um, index), pi * s.radius_um * s.radius_um);
  return sums;
}

}  // namespace

const std::vector<double>& mie_angles_rad() {
  static const std::vector<double> angles = [] {
    std::vector<double> degrees{0};
    // The forward peak of a sphere of size parameter 5000 is 0.04 degrees wide.
    for (double a = 0.01; a < 1; a *= 1.18) degrees.push_back(a);
    for (double a = 1; a < 10; a += 0.25) degrees.push_back(a);
    for (double a = 10; a < 165; a += 1.25) degrees.push_back(a);
    for (double a = 165; a <= 180; a += 0.25) degrees.push_back(a);
    for (double& a : degrees) a *= pi / 180;
    return degrees;
  }();
  return angles;
}

MieOptics mie_optics(const MieSpheres& spheres, const std::vector<double>& wavelengths_nm) {
  const Complex index(spheres.refractive_index[0], spheres.refractive_index[1]);
  const bool alike = std::log(spheres.geometric_sigma) < 4 * finest_step;
  MieOptics optics;
  for (double nm : wavelengths_nm) {
    look_up();
    const Sums sums = (alike ? one_size : integrate_sizes)(spheres, index, nm / 1000);
    optics.extinction_um2.push_back(sums.extinction);
    optics.scattering_um2.push_back(sums.scattering);
    optics.phase.push_back(normalised_phase(mie_angles_rad(), sums.phase));
  }
  return optics;
}

}  // namespace cyanometer
