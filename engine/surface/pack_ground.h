// A ground in the device's layout, shaders/surface/data.glsl.
#pragma once

#include <cmath>
#include <vector>

#include "engine/physics/physics.h"
#include "engine/surface/ground.h"

namespace cyanometer {

template <class Real>
glm::vec<4, Real> packed_image(const SurfaceImages::Place& image) {
  return {image.width, image.height, image.levels, image.first};
}

template <class Real>
std::vector<glm::vec<4, Real>> packed_ground(const Ground& g) {
  using Vec4 = glm::vec<4, Real>;
  double latitude = glm::radians(g.latitude_deg), longitude = glm::radians(g.longitude_deg);
  glm::dvec3 up(std::cos(latitude) * std::cos(longitude),
                std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  glm::dvec3 east(-std::sin(longitude), std::cos(longitude), 0);
  std::vector<Vec4> values{
      Vec4(g.relief_km, g.sea_level, g.gain, g.slope_variance),
      Vec4(g.ice_latitude_deg, g.vegetation, g.seed, g.mean_sea_reflectance),
      packed_image<Real>(g.images ? g.images->colours : SurfaceImages::Place{}),
      packed_image<Real>(g.images ? g.images->heights : SurfaceImages::Place{}),
      Vec4(glm::vec<3, Real>(east), Real(0)),
      Vec4(glm::vec<3, Real>(glm::cross(up, east)), Real(0)),
      Vec4(glm::vec<3, Real>(up), Real(0))};
  auto append = [&](const std::vector<double>& list) {
    for (std::size_t first = 0; first < list.size(); first += 4) {
      Vec4 four(0);
      for (int lane = 0; lane < 4 && first + lane < list.size(); ++lane) {
        four[lane] = static_cast<Real>(list[first + lane]);
      }
      values.push_back(four);
    }
  };
  append(g.sea_reflectance);
  for (const std::vector<double>& spectrum : g.albedo) append(spectrum);
  return values;
}

}  // namespace cyanometer
