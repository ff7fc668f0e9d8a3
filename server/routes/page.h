// The embedded page's files.
#pragma once

#include <string_view>

namespace cyanometer {

/// Whether the page has a file at this path; "/" is its index.html.
bool is_page_file(std::string_view path);

}  // namespace cyanometer
