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

namespace {

/// Of the interval of the table that begins at `low`: its length is cut so that neither the
/// function nor the highest polynomial turns much between two of the eight points.
void add_interval(double low, double high, double f_low, double f_high,
                  std::vector<double>& chi) {
  static const GaussRule rule = gauss_legendre(8);
  int degree = static_cast<int>(chi.size()) - 1;
  bool logarithmic = f_low > 0 && f_high > 0;
  double turns = (high - low) * degree / 2;
  double folds = logarithmic ? std::abs(std::log(f_high / f_low)) / 4 : 0;
  int parts = 1 + static_cast<int>(turns + folds);
  for (int part = 0; part < parts; ++part) {
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      double x = (part + rule.nodes[k]) / parts, theta = low + (high - low) * x;
      double f =
          logarithmic ? f_low * std::pow(f_high / f_low, x) : f_low + (f_high - f_low) * x;
      double weight =
          2 * std::numbers::pi * f * std::sin(theta) * rule.weights[k] * (high - low) / parts;
      double mu = std::cos(theta), before = 0, p = 1;
      for (int l = 0; l <= degree; ++l) {
        chi[l] += weight * p;
        double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
        before = p;
        p = next;
      }
    }
  }
}

}  // namespace

std::vector<double> tabulated_coefficients(const std::vector<double>& angle_rad,
                                           const std::vector<double>& values, int degree) {
  std::vector<double> chi(degree + 1, 0.0);
  for (std::size_t i = 0; i + 1 < angle_rad.size(); ++i) {
    add_interval(angle_rad[i], angle_rad[i + 1], values[i], values[i + 1], chi);
  }
  return chi;
}

}  // namespace cyanometer
