// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace cyanometer {

/// Nodes and weights of n-point Gauss-Legendre quadrature on [0, 1].
struct GaussRule {
  std::vector<double> nodes, weights;
};
GaussRule gauss_legendre(int n);

}  // namespace cyanometer
