#include "engine/optics/spectrum.h"

#include <cmath>

#include "engine/optics/interpolate.h"
#include "engine/optics/sunlight.h"

namespace cyanometer {
namespace {

double interpolate_either_way(std::vector<double> xs, std::vector<double> ys, double x) {
  if (xs.front() > xs.back()) {
    std::ranges::reverse(xs);
    std::ranges::reverse(ys);
  }
  return interpolate(xs, ys, x);
}

struct AtWavelength {
  const std::vector<double>& scene_wavelengths_nm;
  double wavelength_nm;

  double operator()(double constant) const { return constant; }
  double operator()(const PerWavelength& array) const {
    return interpolate_either_way(scene_wavelengths_nm, array.values, wavelength_nm);
  }
  double operator()(const PowerLaw& law) const {
    return law.value * std::pow(wavelength_nm / law.at_nm, law.exponent);
  }
  double operator()(const SampledSpectrum& samples) const {
    return interpolate(samples.wavelengths_nm, samples.values, wavelength_nm);
  }

  double operator()(const MeasuredSunlight&) const { return measured_sunlight(wavelength_nm); }
  double operator()(const Blackbody& body) const {
    return blackbody_sunlight(body.blackbody_k, wavelength_nm);
  }
  double operator()(const Spectrum& spectrum) const { return std::visit(*this, spectrum); }
};

}  // namespace

double evaluate(const Spectrum& spectrum, const std::vector<double>& scene_wavelengths_nm,
                double wavelength_nm) {
  return std::visit(AtWavelength{scene_wavelengths_nm, wavelength_nm}, spectrum);
}

std::vector<double> evaluate(const Spectrum& spectrum,
                             const std::vector<double>& scene_wavelengths_nm,
                             const std::vector<double>& wavelengths_nm) {
  std::vector<double> values;
  for (double l : wavelengths_nm) values.push_back(evaluate(spectrum, scene_wavelengths_nm, l));
  return values;
}

double sunlight(const Sun& sun, const std::vector<double>& scene_wavelengths_nm,
                double wavelength_nm) {
  const double given =
      std::visit(AtWavelength{scene_wavelengths_nm, wavelength_nm}, sun.irradiance);
  if (std::holds_alternative<Spectrum>(sun.irradiance)) return given;
  return given / (sun.solar_distance_au * sun.solar_distance_au);
}

}  // namespace cyanometer
