#include "engine/sky/stars.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/sky/pixel.h"

namespace cyanometer {
namespace {

constexpr double sun_magnitude = -26.74;    // [Willmer 2018, V band]
constexpr double sun_temperature_k = 5772;  // [IAU 2015 resolution B3]

/// Of a uniform double in [0, 1), the same on every platform (distributions of <random> are
/// not).
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Planck's law relative to 550 nm.
double planck_ratio(double wavelength_nm, double kelvin) {
  constexpr double c2_nm_k = 1.438776877e7;
  double x = 550 / wavelength_nm;
  return std::pow(x, 5) * std::expm1(c2_nm_k / (550 * kelvin)) /
         std::expm1(c2_nm_k / (wavelength_nm * kelvin));
}

std::vector<Star> make_catalogue() {
  // Counts of the naked-eye sky: log10 N(brighter than m) = 0.6 + 0.51 m, a few at 0, some
  // 8,000 at 6.5 [after Allen's Astrophysical Quantities, section 19.10].
  constexpr int count = 8200;
  std::mt19937_64 random(1789);
  std::vector<Star> stars;
  stars.reserve(count);
  for (int k = 0; k < count; ++k) {
    double z = 2 * uniform(random) - 1, angle = 2 * std::numbers::pi * uniform(random);
    double rim = std::sqrt(1 - z * z);
    // Bright stars are mostly hot or giant: temperatures spread evenly in the logarithm.
    double kelvin = 3200 * std::pow(20000.0 / 3200, uniform(random));
    stars.push_back({{rim * std::cos(angle), rim * std::sin(angle), z},
                     (std::log10(k + 0.5) - 0.6) / 0.51,
                     kelvin});
  }
  return stars;
}

}  // namespace

const std::vector<Star>& star_catalogue() {
  static const std::vector<Star> catalogue = make_catalogue();
  return catalogue;
}

double star_irradiance(const Star& star, double wavelength_nm) {
  // The hydrogen between the stars lets nothing through below the Lyman limit [Cruddace et al.
  // 1974]; a black body's share of the sun's there soon has no float.
  constexpr double lyman_limit_nm = 91.18;
  if (wavelength_nm < lyman_limit_nm) return 0;
  return std::pow(10, -0.4 * (star.magnitude - sun_magnitude)) *
         planck_ratio(wavelength_nm, star.temperature_k) /
         planck_ratio(wavelength_nm, sun_temperature_k);
}

glm::dmat3 sky_to_local(const Camera& camera) {
  double latitude = glm::radians(camera.latitude_deg);
  double local_time = glm::radians(camera.sidereal_time_deg + camera.longitude_deg);
  glm::dvec3 up(std::cos(latitude) * std::cos(local_time),
                std::cos(latitude) * std::sin(local_time), std::sin(latitude));
  glm::dvec3 east(-std::sin(local_time), std::cos(local_time), 0);
  return glm::transpose(glm::dmat3(east, glm::cross(up, east), up));
}

const std::vector<float>& StarLight::at(double wavelength_nm) {
  constexpr std::size_t most = 64;
  auto known = by_wavelength_.find(wavelength_nm);
  if (known != by_wavelength_.end()) return known->second;
  if (by_wavelength_.size() >= most) by_wavelength_.clear();
  std::vector<float>& light = by_wavelength_[wavelength_nm];
  for (const Star& star : star_catalogue()) {
    light.push_back(static_cast<float>(star_irradiance(star, wavelength_nm)));
  }
  return light;
}

StarPixels star_pixels(const Problem& problem, Physics<double>& camera, StarLight& light) {
  glm::dmat3 turn = sky_to_local(problem.camera);
  std::vector<std::pair<int, std::size_t>> seen;  // pixel, star
  const std::vector<Star>& stars = star_catalogue();
  for (std::size_t k = 0; k < stars.size(); ++k) {
    std::optional<int> pixel = pixel_of(camera, turn * stars[k].direction);
    if (pixel && camera.pixel_ray(*pixel).inside) seen.emplace_back(*pixel, k);
  }
  std::sort(seen.begin(), seen.end());
  StarPixels result;
  for (const auto& [pixel, star] : seen) {
    if (result.pixels.empty() || result.pixels.back() != pixel) result.pixels.push_back(pixel);
  }
  const auto beside_sun = static_cast<float>(std::pow(problem.solar_distance_au, 2));
  std::size_t groups = static_cast<std::size_t>(camera.GROUPS);
  result.radiance.resize(result.pixels.size() * groups, glm::vec4(0));
  for (std::size_t w = 0; w < problem.wavelengths_nm.size(); ++w) {
    const std::vector<float>& irradiance = light.at(problem.wavelengths_nm[w]);
    std::size_t at = 0;
    for (const auto& [pixel, star] : seen) {
      if (result.pixels[at] != pixel) ++at;
      result.radiance[at * groups + w / 4][static_cast<int>(w % 4)] += irradiance[star];
    }
  }
  for (std::size_t at = 0; at < result.pixels.size(); ++at) {
    float solid_angle = static_cast<float>(pixel_solid_angle(camera, result.pixels[at]));
    for (std::size_t g = 0; g < groups; ++g)
      result.radiance[at * groups + g] *= beside_sun / solid_angle;
  }
  return result;
}

}  // namespace cyanometer
