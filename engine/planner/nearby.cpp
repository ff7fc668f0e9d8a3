#include "engine/planner/nearby.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cyanometer {
namespace {

double rounded(double value, double step) { return std::round(value / step) * step; }

/// To powers of a ratio.
double rounded_by_ratio(double value, double ratio) {
  return value > 0 ? std::pow(ratio, std::round(std::log(value) / std::log(ratio))) : value;
}

double sun_step_deg(double elevation_deg) {
  if (elevation_deg > 20) return 2;
  return elevation_deg > 5 ? 1 : 0.5;
}

/// The same shape with as many pixels or some more.
void round_size(Image& image) {
  constexpr double steps_of_doubling = 4;
  const double pixels = static_cast<double>(image.width) * image.height;
  const double step = std::ceil(steps_of_doubling * std::log2(pixels) - 1e-9);
  const double scale = std::max(std::sqrt(std::exp2(step / steps_of_doubling) / pixels), 1.0);
  bool fixed_shape = image.width == 2 * image.height || image.height == 6 * image.width;
  int width = std::max(1, static_cast<int>(std::lround(image.width * scale)));
  int height = std::max(1, static_cast<int>(std::lround(image.height * scale)));
  if (fixed_shape) {
    if (image.width == 2 * image.height) width = 2 * height;
    if (image.height == 6 * image.width) height = 6 * width;
  }
  image.width = width;
  image.height = height;
}

/// To the next power of a ratio.
double rounded_up(double amount) {
  constexpr double ratio = 1.08;
  if (!(amount > 0)) return amount;
  return std::pow(ratio, std::ceil(std::log(amount) / std::log(ratio) - 1e-9));
}

void round_up(double& amount) { amount = rounded_up(amount); }

void round_up(Spectrum& spectrum) {
  struct {
    void operator()(double& value) const { round_up(value); }
    void operator()(PowerLaw& law) const { round_up(law.value); }
    void operator()(PerWavelength& each) const { scale(each.values); }
    void operator()(SampledSpectrum& sampled) const { scale(sampled.values); }
    static void scale(std::vector<double>& values) {
      const double most = *std::ranges::max_element(values);
      if (!(most > 0)) return;
      const double factor = rounded_up(most) / most;
      // In floats, which differences in the last bit of a product do not tell apart.
      for (double& value : values) value = static_cast<float>(value * factor);
    }
  } visitor;
  std::visit(visitor, spectrum);
}

/// How much there is of each constituent, up by less than a tenth: more is harder.
struct RoundAmountUp {
  void operator()(Molecules& molecules) const { std::visit(*this, molecules.optics); }
  void operator()(Particles& particles) const { std::visit(*this, particles.optics); }
  void operator()(Absorber& absorber) const { std::visit(*this, absorber.optics); }
  void operator()(Gas& gas) const { round_up(gas.pressure_pa); }
  void operator()(ScatteringCoefficient& of) const { round_up(of.scattering_per_km); }
  void operator()(ParticleCoefficients& of) const {
    round_up(of.scattering_per_km);
    round_up(of.absorption_per_km);
  }
  void operator()(ParticleOpticalDepth& of) const { round_up(of.optical_depth); }
  void operator()(MieOpticalDepth& of) const { round_up(of.value); }
  void operator()(Visibility& of) const {
    of.visibility_km = 1 / rounded_up(1 / of.visibility_km);
  }
  void operator()(AbsorptionCoefficient& of) const { round_up(of.absorption_per_km); }
  void operator()(Ozone& ozone) const { round_up(ozone.dobson_units); }
};

/// From outside the air, with little of the planet in the frame or nothing: turned a little,
/// the camera sees another share of it.
bool looks_past_planet(const Scene& scene) {
  const Camera& camera = scene.camera;
  const double top_km = scene.planet.radius_km + scene.atmosphere.thickness_km,
               distance_km = scene.planet.radius_km + camera.altitude_km;
  if (distance_km <= top_km) return false;
  const double limb_deg = std::asin(top_km / distance_km) * 180 / std::numbers::pi;
  return camera.pitch_deg + 90 > limb_deg + camera.fov_deg / 4;
}

}  // namespace

Scene nearby(const Scene& scene) {
  Scene near = scene;
  double elevation = near.sun.elevation_deg;
  near.sun.elevation_deg = std::clamp(rounded(elevation, sun_step_deg(elevation)), -90.0, 90.0);
  for (auto& [name, constituent] : near.atmosphere.constituents)
    std::visit(RoundAmountUp(), constituent.matter);
  Camera& camera = near.camera;
  double step = std::min(camera.fov_deg / 8, 5.0);
  if (!looks_past_planet(scene)) {
    camera.pitch_deg = std::clamp(rounded(camera.pitch_deg, step), -90.0, 90.0);
    camera.roll_deg = rounded(camera.roll_deg, 15);
  }
  // Only the angle between heading and sun matters.
  near.sun.azimuth_deg = rounded(
      std::remainder(scene.sun.azimuth_deg - camera.heading_deg, 360), std::max(step, 1.0));
  camera.heading_deg = 0;
  if (camera.altitude_km < near.atmosphere.thickness_km) {
    camera.altitude_km =
        std::min(rounded_by_ratio(camera.altitude_km, 1.25), near.atmosphere.thickness_km);
  }
  camera.latitude_deg = camera.longitude_deg = camera.sidereal_time_deg = 0;
  near.image = {};
  near.image.width = scene.image.width;
  near.image.height = scene.image.height;
  round_size(near.image);
  return near;
}

}  // namespace cyanometer
