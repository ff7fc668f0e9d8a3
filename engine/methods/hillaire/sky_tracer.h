// Rays from a table of the sky as the camera sees it: columns and phase functions exact, the
// rest interpolated. Other methods take their first order from here.
#pragma once

#include "engine/methods/hillaire/tables.h"

namespace cyanometer::hillaire {

class SkyTracer {
 public:
  explicit SkyTracer(vulkan::Device& device);

  /// Whether the table can stand for this scene: it is of one parallel beam, from inside the
  /// air.
  bool serves(const UploadedScene& scene, const Sizes& sizes) const;
  /// Leaves all quantities complete of the tile's rays that go on as far as they can; by tables
  /// of parts (Sizes::of_parts) of those that end in the air.
  void trace(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes,
             const TablesOfView& tables, const Tile& tile);

 private:
  vulkan::Kernel pixels_;
  std::size_t most_bytes_;
};

}  // namespace cyanometer::hillaire
