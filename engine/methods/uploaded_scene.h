// A scene on the device, in the buffers that every method binds first.
#pragma once

#include <memory>
#include <span>
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

/// Where each ray of a frame ends, km from the camera.
class RayEnds {
 public:
  /// A ray that ends at 1e30 or beyond goes on as far as it can.
  RayEnds(vulkan::Device& device, std::span<const float> km);

  /// Whether any, and whether all of these rays end somewhere.
  bool any(int first, int count) const;
  bool all(int first, int count) const;
  int count() const { return static_cast<int>(km().size()); }
  std::span<const float> km() const { return buffer_.as<const float>(); }
  const vulkan::Buffer& buffer() const { return buffer_; }

 private:
  vulkan::Buffer buffer_;
};

/// Of a ground that differs from place to place; null where there is none.
struct GroundBuffers {
  std::shared_ptr<const vulkan::Buffer> texels;        ///< of a map
  std::shared_ptr<const vulkan::Buffer> distances_km;  ///< how far it is along each ray
};

class UploadedScene {
 public:
  static constexpr int bindings = 12;  ///< 0 to 11 of shaders/device.glsl

  /// The rays are `directions` (unit; x east, y north, z up at the foot point), or the camera's
  /// where there are none. `ends` is theirs, none where all go on as far as they can;
  /// `ground` belongs to a ground that is not the same everywhere.
  UploadedScene(vulkan::Device& device, const Problem& problem,
                const std::vector<glm::dvec3>& directions = {},
                std::shared_ptr<const RayEnds> ends = nullptr, GroundBuffers ground = {});

  /// The same scene and other directions of as many rays as they are; of one that was uploaded
  /// with some, and without ends or a ground of its own.
  UploadedScene with_directions(vulkan::Device& device,
                                const std::vector<glm::dvec3>& directions) const;

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
  /// Whether any, and whether all of these rays end before they have to.
  bool any_ends(int first, int count) const { return ends_ && ends_->any(first, count); }
  bool all_end(int first, int count) const { return ends_ && ends_->all(first, count); }

  /// Null where the ground is the same everywhere.
  const vulkan::Buffer* ground_km() const { return ground_.distances_km.get(); }

  /// The scene's bindings followed by a kernel's own.
  std::vector<vulkan::Binding> bind(std::initializer_list<vulkan::Binding> own) const;

 private:
  UploadedScene(vulkan::Device& device, const Problem& problem, const Physics<float>& physics,
                std::shared_ptr<const RayEnds> ends, GroundBuffers ground);

  Problem problem_;
  std::string air_key_;
  std::vector<std::pair<std::size_t, std::size_t>> parts_;  ///< offset and size by binding
  std::shared_ptr<const vulkan::Buffer> buffer_;
  std::shared_ptr<const vulkan::Buffer> directions_;  ///< null where they are in that
  std::shared_ptr<const RayEnds> ends_;
  GroundBuffers ground_;
  vulkan::Specialization constants_;
  int groups_, media_, disc_points_, density_iterations_, profile_nodes_, kinks_;
};

}  // namespace cyanometer
