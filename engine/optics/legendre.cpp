#include "engine/optics/legendre.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/gauss_legendre.h"

namespace cyanometer {

std::vector<double> rayleigh_coefficients(double gamma, int degree) {
  std::vector<double> chi(degree + 1, 0.0);
  chi[0] = 1;
  if (degree >= 2) chi[2] = (1 - gamma) / (10 * (1 + 2 * gamma));
  return chi;
}

std::vector<double> henyey_greenstein_coefficients(double g, int degree) {
  std::vector<double> chi(degree + 1, 1.0);
  for (int l = 1; l <= degree; ++l) chi[l] = chi[l - 1] * g;
  return chi;
}

std::vector<double> cornette_shanks_coefficients(double g, int degree) {
  std::vector<double> hg = henyey_greenstein_coefficients(g, degree + 2);
  std::vector<double> chi(degree + 1);
  for (int n = 0; n <= degree; ++n) {
    double l = n;
    double up = (l + 1) * (l + 2) / ((2 * l + 1) * (2 * l + 3));
    double same = (l + 1) * (l + 1) / ((2 * l + 1) * (2 * l + 3)) +
                  (n > 0 ? l * l / ((2 * l - 1) * (2 * l + 1)) : 0.0);
    double down = n > 1 ? l * (l - 1) / ((2 * l - 1) * (2 * l + 1)) * hg[n - 2] : 0.0;
    chi[n] = 1.5 / (2 + g * g) * ((1 + same) * hg[n] + up * hg[n + 2] + down);
  }
  return chi;
}

double legendre_sum(const std::vector<double>& chi, double cosine) {
  double sum = 0, before = 0, p = 1;
  for (std::size_t l = 0; l < chi.size(); ++l) {
    double n = static_cast<double>(l);
    sum += (2 * n + 1) * chi[l] * p;
    double next = ((2 * n + 1) * cosine * p - n * before) / (n + 1);
    before = p;
    p = next;
  }
  return sum;
}

namespace {

/// The integrals over an interval of a table are summed for all its functions at once: they
/// share the polynomials, which are most of the work.
class IntervalSums {
 public:
  IntervalSums(std::size_t functions, int degree)
      : functions_(functions), degree_(degree), chi_(functions * (degree + 1), 0.0) {
    for (int l = 0; l <= degree; ++l) {
      up_.push_back((2.0 * l + 1) / (l + 1));
      down_.push_back(l / (l + 1.0));
    }
  }

  /// The interval's length is cut so that neither a function nor the highest polynomial turns
  /// much between two of the eight points.
  void add(double low, double high, const std::vector<double>& f_low,
           const std::vector<double>& f_high) {
    static const GaussRule rule = gauss_legendre(8);
    double folds = 0;
    for (std::size_t i = 0; i < functions_; ++i) {
      if (is_logarithmic(f_low[i], f_high[i])) {
        folds = std::max(folds, std::abs(std::log(f_high[i] / f_low[i])) / 4);
      }
    }
    int parts = 1 + static_cast<int>((high - low) * degree_ / 2 + folds);
    std::vector<double> weighted(functions_);
    for (int part = 0; part < parts; ++part) {
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        double x = (part + rule.nodes[k]) / parts, theta = low + (high - low) * x;
        double weight =
            2 * std::numbers::pi * std::sin(theta) * rule.weights[k] * (high - low) / parts;
        for (std::size_t i = 0; i < functions_; ++i) {
          weighted[i] = weight * between(f_low[i], f_high[i], x);
        }
        add_polynomials(std::cos(theta), weighted);
      }
    }
  }

  /// [function][l]
  std::vector<std::vector<double>> take() const {
    std::vector<std::vector<double>> all(functions_, std::vector<double>(degree_ + 1));
    for (int l = 0; l <= degree_; ++l) {
      for (std::size_t i = 0; i < functions_; ++i) all[i][l] = chi_[l * functions_ + i];
    }
    return all;
  }

 private:
  static bool is_logarithmic(double f_low, double f_high) { return f_low > 0 && f_high > 0; }
  static double between(double f_low, double f_high, double x) {
    return is_logarithmic(f_low, f_high) ? f_low * std::pow(f_high / f_low, x)
                                         : f_low + (f_high - f_low) * x;
  }
  void add_polynomials(double mu, const std::vector<double>& weighted) {
    double before = 0, p = 1;
    double* sum = chi_.data();
    for (int l = 0; l <= degree_; ++l) {
      for (std::size_t i = 0; i < functions_; ++i) *sum++ += weighted[i] * p;
      double next = up_[l] * mu * p - down_[l] * before;
      before = p;
      p = next;
    }
  }

  std::size_t functions_;
  int degree_;
  std::vector<double> chi_;        ///< [l][function]
  std::vector<double> up_, down_;  ///< of the polynomials' recurrence
};

}  // namespace

std::vector<std::vector<double>> tabulated_coefficients(
    const std::vector<double>& angle_rad, const std::vector<std::vector<double>>& values,
    int degree) {
  IntervalSums sums(values.size(), degree);
  std::vector<double> low(values.size()), high(values.size());
  for (std::size_t i = 0; i + 1 < angle_rad.size(); ++i) {
    for (std::size_t f = 0; f < values.size(); ++f) {
      low[f] = values[f][i];
      high[f] = values[f][i + 1];
    }
    sums.add(angle_rad[i], angle_rad[i + 1], low, high);
  }
  return sums.take();
}

}  // namespace cyanometer
