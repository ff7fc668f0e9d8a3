// The shaders' physics as C++: the very files under shaders/, compiled over GLM. With Real =
// float its arrays are what is uploaded; with Real = double it is the oracle that the device is
// tested against.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace cyanometer::physics {

using glm::abs;
using glm::asin;
using glm::asinh;
using glm::atan;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cosh;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::length;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::sin;
using glm::sinh;
using glm::sqrt;
using glm::tan;
using glm::uintBitsToFloat;

#define CONSTANT static constexpr
#define UNROLL
#define ARRAY(T, name, n) const T(&name)[n]
#define OUT_ARRAY(T, name, n) T(&name)[n]
#define INOUT_ARRAY(T, name, n) T(&name)[n]
#define INOUT(T) T&
#define READ(buffer, i) buffer[i]
#define READ_REAL(buffer, i) buffer[i]
#define PROJECTION scene.projection

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"

/// The device's view of one scene, and every function of shaders/physics/ and of the methods on
/// it. None of them changes it; GLSL has no way to say so, hence references to it are not
/// const.
template <class Scalar>
struct Physics {
  using Real = Scalar;
  using Vec2 = glm::vec<2, Real>;
  using Vec3 = glm::vec<3, Real>;
  using Vec4 = glm::vec<4, Real>;
  using Uint = glm::uint;
  using UVec4 = glm::uvec4;

#include "shaders/physics/layout.glsl"

  // Constants of the pipeline (shaders/device.glsl). Arrays have room for the contract's most.
  static constexpr int MEDIA_SIZE = 32;
  static constexpr int GROUPS_SIZE = 16;
  static constexpr int MEDIA_GROUPS_SIZE = MEDIA_SIZE * GROUPS_SIZE;
  int EXPONENTIALS = 0, TENTS = 0, QUADRATICS = 0, UNIFORMS = 0, TABLES = 0;
  int COLUMN_NODES = 8;  ///< 8 or 4
  int MEDIA = 0, GROUPS = 1;
  bool NEAR_SUN = false, MANY_SUNS = false, PHASE_TABLES = true;

  // Buffers, in the order of their bindings.
  SceneData scene{};
  std::vector<MediumData> media;
  std::vector<Vec4> spectra;
  std::vector<Vec4> profile_nodes;
  std::vector<Real> phase_angles;
  std::vector<Vec4> phase_values;
  std::vector<Vec4> sun_points;
  std::vector<Vec4> directions;
  std::vector<Vec4> quadrature;  ///< node, weight; then kinks
  int SURFACE_KIND = 0;          ///< 0 too where a kernel has nothing to do with it
  std::vector<Vec4> surface_values;
  std::shared_ptr<const std::vector<Uint>> surface_texels;  ///< of a map; null without one
  std::vector<Real> ends_km{Real(1e30)};

  // Of the method `path` alone (engine/methods/path/guide.h).
  int SEGMENTS = 8;
  bool GUIDED = false;
  std::vector<Real> path_guide;

  // Tables, each with its constants.
  int OPTICAL_DEPTH_COSINES = 2, OPTICAL_DEPTH_ALTITUDES = 2;
  std::vector<Vec4> optical_depths;
  int MULTIPLE_SUNS = 2, MULTIPLE_ALTITUDES = 2, SKY_VIEW_AZIMUTHS = 2, SKY_VIEW_ELEVATIONS = 4;
  int SKY_VIEW_STOPS = 1;
  std::vector<Vec4> log_multiple, log_irradiance, sky_view;
  std::vector<Real> view_columns;

  const MediumData& medium(int c) const { return media[c]; }
  Vec4 extinction(int c, int group) const { return spectra[(2 + 3 * c) * GROUPS + group]; }
  Vec4 scattering(int c, int group) const { return spectra[(3 + 3 * c) * GROUPS + group]; }
  Vec4 depolarisation(int c, int group) const { return spectra[(4 + 3 * c) * GROUPS + group]; }
  Vec4 ground_albedo(int group) const { return spectra[group]; }
  Vec4 limb_exponent(int group) const { return spectra[GROUPS + group]; }
  Vec3 sun_offset(int k) const { return Vec3(sun_points[k * (GROUPS + 1)]); }
  Uint surface_texel(int i) const { return (*surface_texels)[i]; }
  Vec4 forward_gain(int, int) const { return Vec4(1); }
  Vec4 sun_weight(int k, int group) const { return sun_points[k * (GROUPS + 1) + 1 + group]; }
  Vec4 disc_scale(int group) const {
    return sun_points[scene.disc_points * (GROUPS + 1) + group];
  }

// In the order in which they build up.
// clang-format off
#include "shaders/physics/constants.glsl"
#include "shaders/physics/sphere.glsl"
#include "shaders/physics/profile.glsl"
#include "shaders/physics/quadrature.glsl"
#include "shaders/physics/columns.glsl"
#include "shaders/physics/phase.glsl"
#include "shaders/physics/sun.glsl"
#include "shaders/physics/camera.glsl"
#include "shaders/physics/shadow.glsl"
#include "shaders/physics/transfer.glsl"
#include "shaders/surface/data.glsl"
#include "shaders/surface/noise.glsl"
#include "shaders/surface/terrain.glsl"
#include "shaders/surface/matter.glsl"
#include "shaders/surface/map.glsl"
#include "shaders/surface/look.glsl"
#include "shaders/surface/sea.glsl"
#include "shaders/surface/ray.glsl"
#include "shaders/surface/light.glsl"
#include "shaders/tables/optical_depth.glsl"
#include "shaders/tables/stops.glsl"
#include "shaders/methods/nishita.glsl"
#include "shaders/methods/moments.glsl"
#include "shaders/methods/raymarch.glsl"
#include "shaders/methods/path.glsl"
#include "shaders/methods/hillaire/coordinates.glsl"
#include "shaders/methods/hillaire/march.glsl"
#include "shaders/methods/hillaire/second_order.glsl"
#include "shaders/methods/hillaire/multiple.glsl"
#include "shaders/methods/hillaire/view.glsl"
#include "shaders/methods/hillaire/sky_view.glsl"
#include "shaders/methods/bruneton/grid.glsl"
  // clang-format on
};

#pragma GCC diagnostic pop
#undef CONSTANT
#undef UNROLL
#undef ARRAY
#undef OUT_ARRAY
#undef INOUT_ARRAY
#undef INOUT
#undef READ
#undef READ_REAL
#undef PROJECTION

static_assert(sizeof(Physics<float>::SceneData) == 160);
static_assert(sizeof(Physics<float>::MediumData) == 32);

}  // namespace cyanometer::physics
