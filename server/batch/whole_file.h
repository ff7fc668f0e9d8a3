// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace cyanometer {

/// Writes beside the file, then renames.
/// @throws std::runtime_error; what was there before is left as it was
void write_whole(const std::filesystem::path& file, std::string_view bytes);

}  // namespace cyanometer
