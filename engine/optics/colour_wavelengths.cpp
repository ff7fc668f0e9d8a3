#include <array>
#include <cmath>
#include <cstddef>

#include "engine/optics/colour.h"
#include "engine/optics/interpolate.h"

namespace cyanometer {
namespace {

// Wavelengths are spread with this density (its natural logarithm), and the first and last
// stand off the ends by this part of a step, beyond which colour is taken as constant. Both
// were fitted to make the root mean square of the relative errors of X, Y and Z small, for 3 to
// 45 wavelengths together, over the skies, grounds and suns of
// tests/optics/colour_wavelengths_test.cpp: air masses 1 to 38, aerosol optical depths 0.02 to
// 0.4, 300 Dobson units of ozone on paths of up to 45 air masses.
//
//   wavelengths          3    4    5    6    8     10    12    16     24     32     48     64
//   rms error            0.30 0.16 0.10 0.07 0.035 0.026 0.015 0.0090 0.0039 0.0024 0.0012
//   0.0007
constexpr std::array knots_nm{360., 400., 430., 460., 490., 520., 550.,
                              580., 610., 640., 670., 700., 740., 830.};
constexpr std::array log_density{-2.81, -1.63, 0.09,  0.67,  0.79,  0.36,  0.20,
                                 -0.16, 0.20,  -0.28, -0.87, -1.96, -3.71, -4.33};
constexpr double stand_off = 0.601;

struct Spread {
  std::vector<double> wavelengths_nm;
  std::vector<double> share;  ///< of all wavelengths, below each

  Spread() {
    constexpr double step_nm = 0.25;
    double sum = 0, before = 0;
    for (double l = shortest_visible_nm; l <= longest_visible_nm; l += step_nm) {
      const double density = std::exp(interpolate(knots_nm, log_density, l));
      if (!share.empty()) sum += (before + density) / 2;
      before = density;
      wavelengths_nm.push_back(l);
      share.push_back(sum);
    }
    for (double& s : share) s /= sum;
  }
};

}  // namespace

std::vector<double> colour_wavelengths(int count) {
  static const Spread spread;
  std::vector<double> wavelengths;
  for (int i = 0; i < count; ++i)
    wavelengths.push_back(interpolate(spread.share, spread.wavelengths_nm,
                                      (i + stand_off) / (count - 1 + 2 * stand_off)));
  return wavelengths;
}

}  // namespace cyanometer
