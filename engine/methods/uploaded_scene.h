// A scene on the device, in the buffers that every method binds first.
#pragma once

#include <string>
#include <vector>

#include "engine/physics/pack.h"
#include "engine/problem.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/kernel.h"

namespace cyanometer {

/// Wavelengths that are traced together. Software drivers take minutes to compile a march that
/// keeps dozens in registers, and gain nothing from it.
inline constexpr std::size_t wavelengths_at_once = 16;

class UploadedScene {
 public:
  static constexpr int bindings = 9;  ///< 0 to 8 of shaders/device.glsl

  /// The rays are `directions` (unit; x east, y north, z up at the foot point), or the camera's
  /// where there are none.
  UploadedScene(vulkan::Device& device, const Problem& problem,
                const std::vector<glm::dvec3>& directions = {});

  const Problem& problem() const { return problem_; }
  /// All that the air and the ground are, as bytes: with equal keys, tables that depend on
  /// neither sun nor camera are equal.
  const std::string& air_key() const { return air_key_; }
  const vulkan::Specialization& constants() const { return constants_; }
  int groups() const { return groups_; }  ///< of four wavelengths
  int media() const { return media_; }
  int disc_points() const { return disc_points_; }
  /// Rounds of all loops that one evaluation of the densities may take, none unrolled.
  int density_iterations() const { return density_iterations_; }
  int profile_nodes() const { return profile_nodes_; }  ///< of all tabulated profiles
  int kinks() const { return kinks_; }                  ///< where a ray is cut

  /// The scene's bindings followed by a kernel's own.
  std::vector<vulkan::Binding> bind(std::initializer_list<vulkan::Binding> own) const;

 private:
  UploadedScene(vulkan::Device& device, const Problem& problem, const Physics<float>& physics);

  Problem problem_;
  std::string air_key_;
  std::vector<std::pair<std::size_t, std::size_t>> parts_;  ///< offset and size by binding
  vulkan::Buffer buffer_;
  vulkan::Specialization constants_;
  int groups_, media_, disc_points_, density_iterations_, profile_nodes_, kinks_;
};

}  // namespace cyanometer
