// The stars behind the air: a seeded catalogue with the counts and colours of a real sky, and
// the pixels of a frame that hold one.
#pragma once

#include <map>
#include <vector>

#include "engine/physics/pack.h"
#include "engine/problem.h"

namespace cyanometer {

struct Star {
  glm::dvec3 direction;  ///< unit; z is the sky's pole, x the vernal equinox
  double magnitude;      ///< visual
  double temperature_k;  ///< of a black body of the same colour
};

/// Some 8,000 stars down to magnitude 6.5, as an eye sees them, brightest first.
const std::vector<Star>& star_catalogue();

/// Irradiance of a star as a share of the sun's at a wavelength: black bodies of both
/// temperatures, scaled to the visual magnitudes at 550 nm; the sun as from the Earth, -26.74.
/// 0 below the Lyman limit, 91.18 nm.
double star_irradiance(const Star& star, double wavelength_nm);

/// star_irradiance of the whole catalogue, kept between frames: their wavelengths seldom
/// change.
class StarLight {
 public:
  /// By star, in the catalogue's order; valid until the next call.
  const std::vector<float>& at(double wavelength_nm);

 private:
  std::map<double, std::vector<float>> by_wavelength_;  ///< a few dozen at most
};

/// Turns a direction among the stars to x east, y north, z up at the camera's foot point: the
/// right ascension in its meridian is its sidereal time.
glm::dmat3 sky_to_local(const Camera& camera);

/// The stars that a frame shows: in ascending order of pixels, each pixel once.
struct StarPixels {
  std::vector<int> pixels;
  std::vector<glm::vec4>
      radiance;  ///< [pixel][group of wavelengths], per unit irradiance, 1/sr
};
StarPixels star_pixels(const Problem& problem, Physics<double>& camera, StarLight& light);

}  // namespace cyanometer
