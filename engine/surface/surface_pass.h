// The ground where it differs from place to place: where rays meet it, and what it looks like
// under the light that a method found.
#pragma once

#include "engine/methods/method.h"

namespace cyanometer {

/// What a scene's ground looks like depends on this beside the scene: on the code that makes
/// it, and the files of a map. Empty where the ground is the same everywhere. @throws as
/// surface_key
std::string ground_revision(const Scene& scene);

class SurfacePass {
 public:
  explicit SurfacePass(vulkan::Device& device);

  /// The images of a map, kept with the tables; null where the ground has none.
  std::shared_ptr<const vulkan::Buffer> texels(Tracer& tracer, const Ground& ground);

  /// km from the camera to the ground by ray, 1e30 where a ray does not meet it.
  /// @param rays  of the whole scene
  vulkan::Buffer distances(Tracer& tracer, const UploadedScene& scene, int rays);

  /// What a method leaves of ground that is not the same everywhere.
  enum class Left {
    order_one,  ///< nothing but what the sun itself does
    walks,      ///< all that is reflected but the sun's own light (Method::reflects)
    tables      ///< irradiances and skies over ground of one albedo
  };
  /// Turns what a method left of the ground of a tile into radiance.
  /// @param black  of tables, the values of the same tile over black ground; else any
  void light(Tracer& tracer, const UploadedScene& scene, Left left, const Tile& tile,
             const vulkan::Buffer& black);

 private:
  vulkan::Kernel distance_, light_;
};

}  // namespace cyanometer
