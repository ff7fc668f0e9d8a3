#include "engine/accuracy/without_wavelength.h"

#include <vector>

namespace cyanometer {
namespace {

void erase(std::vector<double>& values, std::size_t index) {
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(index));
}

/// Visits whatever holds spectra, down to the arrays.
struct Shorten {
  std::size_t index;

  void operator()(PerWavelength& array) const { erase(array.values, index); }

  void operator()(Molecules& molecules) const { std::visit(*this, molecules.optics); }
  void operator()(Gas& gas) const { std::visit(*this, gas.refractive_index); }
  void operator()(ScatteringCoefficient& optics) const { (*this)(optics.scattering_per_km); }

  void operator()(Particles& particles) const { std::visit(*this, particles.optics); }
  void operator()(ParticleCoefficients& optics) const {
    (*this)(optics.scattering_per_km);
    (*this)(optics.absorption_per_km);
  }
  void operator()(ParticleOpticalDepth& optics) const {
    (*this)(optics.optical_depth);
    (*this)(optics.single_scattering_albedo);
  }
  void operator()(Visibility& optics) const { (*this)(optics.single_scattering_albedo); }

  void operator()(Absorber& absorber) const { std::visit(*this, absorber.optics); }
  void operator()(AbsorptionCoefficient& optics) const { (*this)(optics.absorption_per_km); }

  void operator()(Spectrum& spectrum) const { std::visit(*this, spectrum); }

  // These are the same at any set of wavelengths.
  void operator()(double) const {}
  void operator()(const PowerLaw&) const {}
  void operator()(const SampledSpectrum&) const {}
  void operator()(const std::string&) const {}
  void operator()(const MieOpticalDepth&) const {}
  void operator()(const Ozone&) const {}
  void operator()(const MeasuredSunlight&) const {}
  void operator()(const Blackbody&) const {}
};

}  // namespace

Scene without_wavelength(const Scene& scene, std::size_t index) {
  Scene result = scene;
  Shorten shorten{index};
  erase(result.spectrum.wavelengths_nm, index);
  shorten(result.planet.ground_albedo);
  if (auto* s = std::get_if<ProceduralSurface>(&result.planet.surface)) {
    for (Spectrum* matter : {&s->sea, &s->plants, &s->sand, &s->rock, &s->ice})
      shorten(*matter);
  }
  std::visit(shorten, result.sun.irradiance);
  for (auto& [name, constituent] : result.atmosphere.constituents) {
    std::visit(shorten, constituent.matter);
  }
  return result;
}

}  // namespace cyanometer
