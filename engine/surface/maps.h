// Maps of surfaces, in the operator's folder: read once for all who have them at the time, and
// kept while there is room.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace cyanometer {

/// Images of a map as the device has them (shaders/surface/map.glsl).
struct SurfaceImages {
  struct Place {
    int width = 0, height = 0, levels = 0, first = 0;  ///< of a texel; 0 levels: no image
  };
  std::string key;  ///< of the files as they were read: their names, times and sizes
  Place colours, heights;
  std::shared_ptr<const std::vector<std::uint32_t>> texels;
  std::array<double, 3> mean_rgb{};  ///< by area, linear
};

/// Where maps are, and the most bytes of them that are kept; an empty folder: there are none.
/// The map used last is kept however large it is. For the whole process.
void use_surfaces(const std::filesystem::path& folder, std::size_t most_bytes);

/// One map is read at a time; who wants one meanwhile waits.
/// @throws SceneError with the member's pointer where no folder is configured, or a file is not
/// there, is none, leads out of the folder or cannot be read as an image
std::shared_ptr<const SurfaceImages> surface_images(const MapSurface& surface);

/// Their `mean_rgb`, without reading a file of colours whose mean is known. @throws as they do
std::array<double, 3> surface_mean_rgb(const MapSurface& surface);

/// The `key` that they would have if they were read now; nothing is read. @throws as they do,
/// but for what is in the files
std::string surface_key(const MapSurface& surface);

}  // namespace cyanometer
