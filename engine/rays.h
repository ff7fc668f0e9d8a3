// The rays that a request traces by themselves: those of a list, and some of a frame's pixels.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/image/picture.h"
#include "engine/optics/colour.h"
#include "engine/physics/pack.h"

namespace cyanometer {

/// Rays that are traced by themselves, as from a list.
struct Rays {
  std::vector<glm::dvec3> directions;
  std::vector<float> ends_km = {};   ///< none where all go on as far as they can
  std::vector<Triple> colours = {};  ///< of what stands at the ends, R, G, B
};

/// One pixel from each cell of an even grid, off its centre so that no row or column of the
/// picture is looked at twice as often as another; those that meet air or ground.
std::vector<int> pixels_of_grid(Physics<double>& camera, int columns, int rows);

/// At least `count` of the frame's pixels that meet air or ground, or nearly all that do.
std::vector<int> stratified_pixels(Physics<double>& camera, int count);

/// @param picture  where the rays of all pixels end, if anywhere
Rays stratified_rays(Physics<double>& camera, int count, const Picture* picture);

/// The scene's wavelengths, or a few where it leaves the choice.
std::vector<double> some_wavelengths_of(const Scene& scene);

}  // namespace cyanometer
