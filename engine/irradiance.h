// Directions and weights that turn radiances into irradiances on a horizontal plane.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/problem.h"

namespace cyanometer {

/// Weights are cosine to the vertical times solid angle, sr.
struct HemisphereRule {
  std::vector<glm::dvec3> directions;
  std::vector<double> weights;
};

/// Gauss-Legendre points over the upper or the lower hemisphere of the camera's place, split
/// where the radiance jumps or bends (horizon, limbs) and gathered about the sun.
HemisphereRule hemisphere_rule(const Problem& problem, bool upper);

}  // namespace cyanometer
