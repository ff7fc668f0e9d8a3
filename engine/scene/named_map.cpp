#include "engine/scene/named_map.h"

#include <algorithm>

namespace cyanometer {

bool is_plain_name(std::string_view name, std::size_t longest) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= longest && is_letter(name.front()) &&
         std::ranges::all_of(
             name, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::string plain_name_pattern(std::size_t longest) {
  return "^[a-z][a-z0-9_]{0," + std::to_string(longest - 1) + "}$";
}

}  // namespace cyanometer
