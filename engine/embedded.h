// Files that are part of the binary.
#pragma once

#include <string_view>
#include <vector>

namespace cyanometer {

struct EmbeddedFile {
  std::string_view path;  ///< relative to the folder they came from
  std::string_view bytes;
};
const std::vector<EmbeddedFile>& preset_files();  ///< engine/scene/presets
const std::vector<EmbeddedFile>& web_files();     ///< web

}  // namespace cyanometer
