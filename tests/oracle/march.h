// The march of shaders/methods/nishita.glsl in double: the device's own code, on the CPU.
#pragma once

#include "engine/accuracy/adaptive.h"

namespace cyanometer::oracle {

inline Ray march(P& p, const glm::dvec3& direction, int view_samples, int light_samples) {
  P::Path path = p.path_from_camera(direction);
  double view_column[P::MEDIA_SIZE] = {}, light_column[P::MEDIA_SIZE] = {};
  glm::dvec4 inscatter[P::GROUPS_SIZE] = {}, ground[P::GROUPS_SIZE] = {};
  P::MarchRange whole = p.whole_march(view_samples, light_samples);
  p.march_view(path, whole, view_samples, light_samples, view_column, light_column, inscatter);
  p.light_ground(path, whole, light_samples, light_column, ground);
  Ray ray;
  for (int g = 0; g < p.GROUPS; ++g) {
    glm::dvec4 transmittance = p.transmittance_of(view_column, g);
    for (int lane = 0; lane < 4; ++lane) {
      ray.inscatter.push_back(inscatter[g][lane]);
      ray.ground.push_back(ground[g][lane] * transmittance[lane]);
      ray.transmittance.push_back(transmittance[lane]);
    }
  }
  return ray;
}

}  // namespace cyanometer::oracle
