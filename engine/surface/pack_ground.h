// A ground in the device's layout, shaders/surface/data.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/physics/physics.h"
#include "engine/surface/ground.h"

namespace cyanometer {

template <class Real>
glm::vec<4, Real> packed_image(const SurfaceImages::Place& image) {
  return {image.width, image.height, image.levels, image.first};
}

/// Where a point lies in the lattice of each octave (shaders/surface/terrain.glsl): its cell
/// and the place in it, as `surface_values` holds them.
/// @param point  from the planet's centre, over its radius
template <class Real>
std::vector<glm::vec<4, Real>> packed_lattice(const glm::dvec3& point) {
  using P = physics::Physics<double>;
  std::vector<glm::vec<4, Real>> values;
  glm::dvec3 p = point * P::FIRST_FREQUENCY;
  for (int octave = 0; octave < P::OCTAVES; ++octave) {
    glm::dvec3 cell = glm::floor(p);
    for (const glm::dvec3& part : {cell, p - cell}) {
      values.push_back(glm::vec<4, Real>(glm::vec<3, Real>(part), Real(0)));
    }
    p = p * 2.0 + glm::dvec3(P::OCTAVE_SHIFT_X, P::OCTAVE_SHIFT_Y, P::OCTAVE_SHIFT_Z);
  }
  return values;
}

/// Places on a procedural surface are then told from the planet's centre, not from a camera's
/// foot point: directions from there.
inline void tell_places_from_centre(physics::Physics<double>& p) {
  using P = physics::Physics<double>;
  p.surface_values[6] = glm::dvec4(0);  // foot_direction
  std::ranges::copy(packed_lattice<double>(glm::dvec3(0)),
                    p.surface_values.begin() + P::SURFACE_LATTICE);
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
  for (const Vec4& value : packed_lattice<Real>(up)) values.push_back(value);
  for (const std::vector<double>& spectrum : g.albedo) append(spectrum);
  return values;
}

}  // namespace cyanometer
