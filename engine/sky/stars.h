// The stars behind the air: a seeded catalogue with the counts and colours of a real sky, and
// the pixels of a frame that hold one.
#pragma once

#include <vector>

#include "engine/physics/pack.h"
#include "engine/problem.h"

namespace cyanometer {

struct Star {
  glm::dvec3 direction;  ///< unit, fixed to the planet: z its axis, x on the meridian 0
  double magnitude;      ///< visual
  double temperature_k;  ///< of a black body of the same colour
};

/// Some 8,000 stars down to magnitude 6.5, as an eye sees them, brightest first.
const std::vector<Star>& star_catalogue();

/// Irradiance of a star as a share of the sun's at a wavelength: black bodies of both
/// temperatures, scaled to the visual magnitudes at 550 nm; the sun as from the Earth, -26.74.
double star_irradiance(const Star& star, double wavelength_nm);

/// The stars that a frame shows: in ascending order of pixels, each pixel once.
struct StarPixels {
  std::vector<int> pixels;
  std::vector<glm::vec4>
      radiance;  ///< [pixel][group of wavelengths], per unit irradiance, 1/sr
};
StarPixels star_pixels(const Problem& problem, Physics<double>& camera);

}  // namespace cyanometer
