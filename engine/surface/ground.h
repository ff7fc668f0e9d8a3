// The ground of a problem where it differs from place to place, as numbers: what the device is
// given of it (shaders/surface/data.glsl).
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/surface/maps.h"

namespace cyanometer {

struct Ground {
  int kind = 0;
  double relief_km = 0;  ///< no height is above it
  double sea_level = 0, gain = 0, slope_variance = 0, ice_latitude_deg = 0, vegetation = 0,
         seed = 0, mean_sea_reflectance = 0;
  std::vector<double> sea_reflectance;          ///< by cosine
  std::vector<double> mean_share;               ///< by matter, of the whole planet
  std::vector<std::vector<double>> albedo;      ///< [matter][wavelength]
  std::shared_ptr<const SurfaceImages> images;  ///< of a map; null without one
  double latitude_deg = 0, longitude_deg = 0;   ///< of the camera's foot point
};

/// None where the scene's ground is the same everywhere.
std::optional<Ground> make_ground(const Scene& scene,
                                  const std::vector<double>& wavelengths_nm);

/// Of Lambertian ground that reflects as much as all of it does under an even sky, by
/// wavelength: what tables take for the light that goes from the ground back into the air.
std::vector<double> mean_albedo(const Ground& ground);
/// The same of the scene's ground, without reading a map whose colours are known; none where
/// the ground is the same everywhere.
std::optional<std::vector<double>> mean_albedo(const Scene& scene,
                                               const std::vector<double>& wavelengths_nm);

/// Of the ground under the camera, km above the sea.
double height_at_foot_km(const Ground& ground, double planet_radius_km);

}  // namespace cyanometer
