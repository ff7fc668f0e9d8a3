// Short names for long texts.
#pragma once

#include <string>
#include <string_view>

namespace cyanometer {

/// FNV-1a with 64 bits, 16 hexadecimal digits: for keys of caches and names of files, which say
/// themselves what they are of; not a secret.
std::string fingerprint(std::string_view text);

}  // namespace cyanometer
