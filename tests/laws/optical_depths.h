// The table of optical depths as the device fills it, in double.
#pragma once

#include "engine/methods/tables/optical_depth_table.h"
#include "engine/physics/pack.h"

namespace cyanometer {

/// `scene` with its table of the first group of wavelengths.
inline Physics<double> with_optical_depths(Physics<double> scene, OpticalDepthSize size) {
  using P = Physics<double>;
  scene.OPTICAL_DEPTH_COSINES = size.cosines;
  scene.OPTICAL_DEPTH_ALTITUDES = size.altitudes;
  for (int row = 0; row < size.altitudes; ++row) {
    for (int column = 0; column < size.cosines; ++column) {
      auto ray = scene.optical_depth_ray(
          {column / (size.cosines - 1.0), row / (size.altitudes - 1.0)});
      double columns[P::MEDIA_SIZE];
      scene.columns_to_top(ray.altitude_km, ray.mu, columns);
      glm::dvec4 depth(0);
      for (int c = 0; c < scene.MEDIA; ++c) depth += scene.extinction(c, 0) * columns[c];
      scene.optical_depths.push_back(depth);
    }
  }
  return scene;
}

}  // namespace cyanometer
