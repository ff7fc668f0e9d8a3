// Where the program keeps what it can make again.
#pragma once

#include <filesystem>
#include <string>

namespace cyanometer {

/// A folder of that name under XDG_CACHE_HOME or ~/.cache [XDG Base Directory Specification];
/// it need not exist. Empty where there is neither.
std::filesystem::path cache_folder(const std::string& name);

}  // namespace cyanometer
