#include "engine/cache_folder.h"

#include <cstdlib>

namespace cyanometer {

std::filesystem::path cache_folder(const std::string& name) {
  auto variable = [](const char* variable_name) -> std::filesystem::path {
    const char* value = std::getenv(variable_name);
    return value ? value : "";
  };
  std::filesystem::path cache = variable("XDG_CACHE_HOME");
  // The specification has relative paths ignored.
  if (cache.is_relative()) cache = variable("HOME") / ".cache";
  return cache.is_relative() ? std::filesystem::path() : cache / "cyanometer" / name;
}

}  // namespace cyanometer
