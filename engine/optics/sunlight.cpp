#include "engine/optics/sunlight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/optics/interpolate.h"

namespace cyanometer {
namespace {

// At 120 to 190 nm every 10, 200 to 995 every 5, 1000 to 1950 every 50, 2000 to 5000 every 200.
constexpr std::array measured_from_120_nm{
    0.0010368, 0.00015582, 5.4736e-5, 0.0001032, 0.00023006, 0.00063997, 0.0017564, 0.0037074,
    0.0065048, 0.010651,   0.023735,  0.035694,  0.04483,    0.05069,    0.048571,  0.047009,
    0.049231,  0.056574,   0.051814,  0.076733,  0.10995,    0.21025,    0.23578,   0.19015,
    0.17856,   0.26738,    0.46992,   0.52476,   0.48259,    0.57263,    0.61688,   0.67322,
    0.71554,   0.82304,    0.97853,   0.91735,   0.93568,    0.91209,    0.95144,   0.97168,
    0.9086,    1.0823,     1.1375,    1.0624,    1.0989,     0.9426,     1.0994,    1.0481,
    1.5396,    1.675,      1.6925,    1.7484,    1.7177,     1.6825,     1.5239,    1.7222,
    1.8095,    1.9298,     2.0313,    2.021,     2.04,       2.0131,     1.9802,    2.0168,
    2.0415,    1.8998,     1.9085,    1.9603,    1.9081,     1.9198,     1.9275,    1.8274,
    1.8031,    1.8674,     1.8884,    1.8965,    1.8515,     1.8701,     1.8686,    1.8634,
    1.8284,    1.8397,     1.8354,    1.8497,    1.8379,     1.829,      1.7662,    1.7871,
    1.7613,    1.7604,     1.7312,    1.6952,    1.7031,     1.6753,     1.6672,    1.6525,
    1.6346,    1.613,      1.5879,    1.5204,    1.5303,     1.5524,     1.5303,    1.5117,
    1.4939,    1.4673,     1.455,     1.4341,    1.4054,     1.3999,     1.3855,    1.3632,
    1.3379,    1.3442,     1.3259,    1.3094,    1.2785,     1.2791,     1.2677,    1.2536,
    1.2404,    1.217,      1.2013,    1.196,     1.1865,     1.1784,     1.1636,    1.1427,
    1.1384,    1.1202,     1.109,     1.105,     1.078,      1.0766,     1.064,     1.0471,
    1.0396,    1.0259,     0.98496,   0.95328,   0.99602,    0.95287,    0.9607,    0.97118,
    0.95997,   0.9483,     0.94474,   0.93609,   0.91737,    0.9137,     0.89905,   0.90057,
    0.88322,   0.86412,    0.86837,   0.85989,   0.8427,     0.83457,    0.83409,   0.81454,
    0.81268,   0.79997,    0.79426,   0.78337,   0.77608,    0.76808,    0.75767,   0.75382,
    0.71747,   0.66252,    0.59943,   0.54824,   0.50271,    0.46009,    0.4167,    0.37589,
    0.34559,   0.3186,     0.29484,   0.27219,   0.24964,    0.22755,    0.2066,    0.18643,
    0.16919,   0.15313,    0.13951,   0.12696,   0.10629,    0.08257,    0.059941,  0.044718,
    0.034028,  0.026267,   0.020556,  0.016297,  0.013099,   0.010609,   0.0087304, 0.0071813,
    0.0059342, 0.0049453,  0.0041536, 0.0035272,
};

struct Measured {
  std::vector<double> wavelengths_nm{10, 110};
  std::vector<double> irradiance{1e-5, 1e-5};

  Measured() {
    irradiance.insert(irradiance.end(), measured_from_120_nm.begin(),
                      measured_from_120_nm.end());
    add_nodes(120, 200, 10);
    add_nodes(200, 1000, 5);
    add_nodes(1000, 2000, 50);
    add_nodes(2000, 5001, 200);
  }
  void add_nodes(int from_nm, int before_nm, int step_nm) {
    for (int l = from_nm; l < before_nm; l += step_nm) wavelengths_nm.push_back(l);
  }
};

}  // namespace

double measured_sunlight(double wavelength_nm) {
  static const Measured measured;
  return interpolate(measured.wavelengths_nm, measured.irradiance, wavelength_nm);
}

double planck(double temperature_k, double wavelength_nm) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double l = wavelength_nm * 1e-9;
  const double per_metre =
      2 * h * c * c / std::pow(l, 5) / std::expm1(h * c / (l * k * temperature_k));
  return per_metre * 1e-9;
}

double blackbody_sunlight(double temperature_k, double wavelength_nm) {
  constexpr double total = 1361, effective_k = 5772, stefan_boltzmann = 5.670374419e-8;
  const double dilution = total / (stefan_boltzmann * std::pow(effective_k, 4));
  return dilution * std::numbers::pi * planck(temperature_k, wavelength_nm);
}

double limb_darkening_exponent(double wavelength_nm) {
  return 292 / std::clamp(wavelength_nm, 416.0, 1099.0) - 0.023;
}

}  // namespace cyanometer
