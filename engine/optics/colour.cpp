#include "engine/optics/colour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace cyanometer {
namespace {

constexpr double table_step_nm = 5;
constexpr std::array<Triple, 95> observer{{
    {0.0001299, 3.917e-6, 0.0006061},
    {0.0002321, 6.965e-6, 0.001086},
    {0.0004149, 1.239e-5, 0.001946},
    {0.0007416, 2.202e-5, 0.003486},
    {0.001368, 3.9e-5, 0.00645},
    {0.002236, 6.4e-5, 0.01055},
    {0.004243, 0.00012, 0.02005},
    {0.00765, 0.000217, 0.03621},
    {0.01431, 0.000396, 0.06785},
    {0.02319, 0.00064, 0.1102},
    {0.04351, 0.00121, 0.2074},
    {0.07763, 0.00218, 0.3713},
    {0.13438, 0.004, 0.6456},
    {0.21477, 0.0073, 1.03905},
    {0.2839, 0.0116, 1.3856},
    {0.3285, 0.01684, 1.62296},
    {0.34828, 0.023, 1.74706},
    {0.34806, 0.0298, 1.7826},
    {0.3362, 0.038, 1.77211},
    {0.3187, 0.048, 1.7441},
    {0.2908, 0.06, 1.6692},
    {0.2511, 0.0739, 1.5281},
    {0.19536, 0.09098, 1.28764},
    {0.1421, 0.1126, 1.0419},
    {0.09564, 0.13902, 0.81295},
    {0.05795, 0.1693, 0.6162},
    {0.03201, 0.20802, 0.46518},
    {0.0147, 0.2586, 0.3533},
    {0.0049, 0.323, 0.272},
    {0.0024, 0.4073, 0.2123},
    {0.0093, 0.503, 0.1582},
    {0.0291, 0.6082, 0.1117},
    {0.06327, 0.71, 0.07825},
    {0.1096, 0.7932, 0.05725},
    {0.1655, 0.862, 0.04216},
    {0.22575, 0.91485, 0.02984},
    {0.2904, 0.954, 0.0203},
    {0.3597, 0.9803, 0.0134},
    {0.43345, 0.99495, 0.00875},
    {0.51205, 1, 0.00575},
    {0.5945, 0.995, 0.0039},
    {0.6784, 0.9786, 0.00275},
    {0.7621, 0.952, 0.0021},
    {0.8425, 0.9154, 0.0018},
    {0.9163, 0.87, 0.00165},
    {0.9786, 0.8163, 0.0014},
    {1.0263, 0.757, 0.0011},
    {1.0567, 0.6949, 0.001},
    {1.0622, 0.631, 0.0008},
    {1.0456, 0.5668, 0.0006},
    {1.0026, 0.503, 0.00034},
    {0.9384, 0.4412, 0.00024},
    {0.85445, 0.381, 0.00019},
    {0.7514, 0.321, 0.0001},
    {0.6424, 0.265, 5e-5},
    {0.5419, 0.217, 3e-5},
    {0.4479, 0.175, 2e-5},
    {0.3608, 0.1382, 1e-5},
    {0.2835, 0.107, 0},
    {0.2187, 0.0816, 0},
    {0.1649, 0.061, 0},
    {0.1212, 0.04458, 0},
    {0.0874, 0.032, 0},
    {0.0636, 0.0232, 0},
    {0.04677, 0.017, 0},
    {0.0329, 0.01192, 0},
    {0.0227, 0.00821, 0},
    {0.01584, 0.005723, 0},
    {0.0113592, 0.004102, 0},
    {0.00811092, 0.002929, 0},
    {0.00579035, 0.002091, 0},
    {0.00410946, 0.001484, 0},
    {0.00289933, 0.001047, 0},
    {0.00204919, 0.00074, 0},
    {0.00143997, 0.00052, 0},
    {0.000999949, 0.0003611, 0},
    {0.000690079, 0.0002492, 0},
    {0.000476021, 0.0001719, 0},
    {0.000332301, 0.00012, 0},
    {0.000234826, 8.48e-5, 0},
    {0.000166151, 6e-5, 0},
    {0.000117413, 4.24e-5, 0},
    {8.30753e-5, 3e-5, 0},
    {5.87065e-5, 2.12e-5, 0},
    {4.15099e-5, 1.499e-5, 0},
    {2.93533e-5, 1.06e-5, 0},
    {2.06738e-5, 7.4657e-6, 0},
    {1.45598e-5, 5.2578e-6, 0},
    {1.0254e-5, 3.7029e-6, 0},
    {7.22146e-6, 2.6078e-6, 0},
    {5.08587e-6, 1.8366e-6, 0},
    {3.58165e-6, 1.2934e-6, 0},
    {2.52253e-6, 9.1093e-7, 0},
    {1.77651e-6, 6.4153e-7, 0},
    {1.25114e-6, 4.5181e-7, 0},
}};

using Chromaticity = std::array<double, 2>;
constexpr Chromaticity red{0.640, 0.330}, green{0.300, 0.600}, blue{0.150, 0.060};
constexpr Chromaticity d65{0.3127, 0.3290};

Triple xyz_at_unit_luminance(const Chromaticity& c) {
  return {c[0] / c[1], 1, (1 - c[0] - c[1]) / c[1]};
}

Matrix from_columns(const Triple& a, const Triple& b, const Triple& c) {
  return {a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2]};
}

Matrix diagonal(const Triple& d) { return {d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]}; }

/// Primaries scaled so that together they make the white.
Matrix xyz_from_primaries() {
  const Matrix primaries = from_columns(
      xyz_at_unit_luminance(red), xyz_at_unit_luminance(green), xyz_at_unit_luminance(blue));
  return primaries * diagonal(inverse(primaries) * xyz_at_unit_luminance(d65));
}

}  // namespace

Triple colour_matching(double wavelength_nm) {
  if (wavelength_nm < shortest_visible_nm || wavelength_nm > longest_visible_nm) return {};
  const double position = (wavelength_nm - shortest_visible_nm) / table_step_nm;
  const auto below = std::min(static_cast<std::size_t>(position), observer.size() - 2);
  Triple value;
  for (std::size_t c = 0; c < 3; ++c)
    value[c] = std::lerp(observer[below][c], observer[below + 1][c],
                         position - static_cast<double>(below));
  return value;
}

Triple operator*(const Matrix& m, const Triple& v) {
  Triple product{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) product[r] += m[3 * r + k] * v[k];
  return product;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) product[3 * r + c] += a[3 * r + k] * b[3 * k + c];
  return product;
}

Matrix inverse(const Matrix& m) {
  Matrix cofactors;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactors[3 * c + r] = m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
    }
  const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
  for (double& element : cofactors) element /= determinant;
  return cofactors;
}

const Matrix& xyz_from_rec709() {
  static const Matrix matrix = xyz_from_primaries();
  return matrix;
}

const Matrix& rec709_from_xyz() {
  static const Matrix matrix = inverse(xyz_from_rec709());
  return matrix;
}

Matrix adaptation_to_d65(const Triple& white_xyz) {
  constexpr Matrix cones_from_xyz{0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                  0.0367, 0.0389, -0.0685, 1.0296};
  const double y = white_xyz[1];
  const Triple source = cones_from_xyz * Triple{white_xyz[0] / y, 1, white_xyz[2] / y};
  const Triple target = cones_from_xyz * xyz_at_unit_luminance(d65);
  Triple gain;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(source[c] > 0))
      throw std::domain_error("a white without one of the cones' responses");
    gain[c] = target[c] / source[c];
  }
  return rec709_from_xyz() * inverse(cones_from_xyz) * diagonal(gain) * cones_from_xyz *
         xyz_from_rec709();
}

}  // namespace cyanometer
