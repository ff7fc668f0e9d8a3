#include "engine/optics/gas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace cyanometer {
namespace {

constexpr double boltzmann = 1.380649e-23;  // J / K
constexpr double standard_pressure_pa = 101325;
constexpr double standard_temperature_k = 288.15;
/// From 0 degrees, where several formulas hold, to 288.15 K at the same pressure (ideal gas).
constexpr double from_0_celsius = 273.15 / standard_temperature_k;

/// s2 is the square of the wavenumber, um^-2; `refractivity` is n - 1 at 101325 Pa and 288.15
/// K.
struct NamedGas {
  std::string_view name;
  double shortest_nm, longest_nm;  ///< range of the refractivity
  double (*refractivity)(double s2);
  double king_shortest_nm, king_longest_nm;
  double (*king)(double s2);
};

/// [Peck and Reeder 1972, J. Opt. Soc. Am. 62, 958], dry air.
double air(double s2) {
  return 1e-8 * (8060.51 + 2480990 / (132.274 - s2) + 17455.7 / (39.32957 - s2));
}
/// [Bideau-Mehu et al. 1973, Opt. Commun. 9, 432], 0 degrees; refit of [Old et al. 1971].
double carbon_dioxide(double s2) {
  return from_0_celsius * (6.99100e-2 / (166.175 - s2) + 1.44720e-3 / (79.609 - s2) +
                           6.42941e-5 / (56.3064 - s2) + 5.21306e-5 / (46.0196 - s2) +
                           1.46847e-6 / (0.0584738 - s2));
}
/// [Peck and Khanna 1966, J. Opt. Soc. Am. 56, 1059] above 468 nm and [Bates 1984, Planet.
/// Space Sci. 32, 785] below, both at 15 degrees, as given by [Sneep and Ubachs 2005].
double nitrogen(double s2) {
  constexpr double join = 1 / (0.468 * 0.468);
  return s2 < join ? 1e-8 * (6497.378 + 3073864.9 / (144 - s2))
                   : 1e-8 * (5677.465 + 3188187.4 / (144 - s2));
}
/// [Peck and Huang 1977, J. Opt. Soc. Am. 67, 1550], 0 degrees.
double hydrogen(double s2) {
  return from_0_celsius * (1.48956e-2 / (180.7 - s2) + 4.9037e-3 / (92 - s2));
}
/// [Mansfield and Peck 1969, J. Opt. Soc. Am. 59, 199], 0 degrees, measured from 480 nm; down
/// to 275 nm it is within 0.3 % of [Cuthbertson and Cuthbertson 1932].
double helium(double s2) { return from_0_celsius * 0.01470091 / (423.98 - s2); }
/// [Hohm 1993, Mol. Phys. 78, 929] as fitted by [He et al. 2021, Atmos. Chem. Phys. 21, 14927],
/// 15 degrees.
double methane(double s2) { return 1e-8 * (3603.09 + 4.40362e6 / (117.41 - s2)); }

/// [Bates 1984], of nitrogen and of oxygen.
double king_nitrogen(double s2) { return 1.034 + 3.17e-4 * s2; }
double king_oxygen(double s2) { return 1.096 + 1.385e-3 * s2 + 1.448e-4 * s2 * s2; }
/// Weighted by parts of dry air with 360 ppm of CO2 [Bodhaine et al. 1999, J. Atmos. Oceanic
/// Technol. 16, 1854, eq. 23].
double king_air(double s2) {
  constexpr double n2 = 78.084, o2 = 20.946, ar = 0.934, co2 = 0.036;
  return (n2 * king_nitrogen(s2) + o2 * king_oxygen(s2) + ar * 1.00 + co2 * 1.15) /
         (n2 + o2 + ar + co2);
}
/// [Alms et al. 1975, J. Chem. Phys. 62, 3321] as given by [Sneep and Ubachs 2005, JQSRT 92,
/// 293].
double king_carbon_dioxide(double s2) { return 1.1364 + 2.53e-3 * s2; }
/// 1 + 2 (anisotropy / (3 mean polarisability))^2 from 0.314 and 0.819 cubic angstroms at 633
/// nm [Bridge and Buckingham 1966, Proc. R. Soc. A 295, 334].
double king_hydrogen(double) { return 1.0327; }
/// Spherical atoms and molecules do not depolarise.
double king_spherical(double) { return 1; }

constexpr double anywhere = 1e9;
constexpr std::array<NamedGas, 6> gases{{
    {"air", 185, 1690, air, 200, 1000, king_air},
    {"co2", 181, 1694, carbon_dioxide, 333, 1000, king_carbon_dioxide},
    {"n2", 254, 2058, nitrogen, 200, 1000, king_nitrogen},
    {"h2", 168, 1694, hydrogen, 0, anywhere, king_hydrogen},
    {"he", 275, 2058, helium, 0, anywhere, king_spherical},
    {"ch4", 307, 725, methane, 0, anywhere, king_spherical},
}};

const NamedGas& find(std::string_view name) {
  const auto gas = std::ranges::find(gases, name, &NamedGas::name);
  if (gas == gases.end()) throw std::out_of_range("no gas is named " + std::string(name));
  return *gas;
}

double squared_wavenumber(double wavelength_nm, double shortest_nm, double longest_nm) {
  const double per_um = 1000 / std::clamp(wavelength_nm, shortest_nm, longest_nm);
  return per_um * per_um;
}

}  // namespace

double refractive_index(std::string_view gas, double wavelength_nm) {
  const NamedGas& g = find(gas);
  return 1 + g.refractivity(squared_wavenumber(wavelength_nm, g.shortest_nm, g.longest_nm));
}

double king_factor(std::string_view gas, double wavelength_nm) {
  const NamedGas& g = find(gas);
  return g.king(squared_wavenumber(wavelength_nm, g.king_shortest_nm, g.king_longest_nm));
}

double molecular_scattering_per_km(double index, double king, double pressure_pa,
                                   double temperature_k, double wavelength_nm) {
  constexpr double standard_density =
      standard_pressure_pa / (boltzmann * standard_temperature_k);  // molecules / m^3
  const double l = wavelength_nm * 1e-9;
  const double lorentz_lorenz = (index * index - 1) / (index * index + 2) / standard_density;
  const double cross_section_m2 = 24 * std::pow(std::numbers::pi, 3) / std::pow(l, 4) *
                                  lorentz_lorenz * lorentz_lorenz * king;
  constexpr double metres_per_km = 1000;
  return cross_section_m2 * pressure_pa / (boltzmann * temperature_k) * metres_per_km;
}

double depolarisation_gamma(double king) {
  const double rho = 6 * (king - 1) / (3 + 7 * king);
  return rho / (2 - rho);
}

}  // namespace cyanometer
