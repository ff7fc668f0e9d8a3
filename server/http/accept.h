// Content negotiation (RFC 9110, section 12.5.1).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cyanometer {

/// Index of the type that the header prefers, the first among equals; none where it takes none.
std::optional<std::size_t> preferred(std::string_view accept,
                                     const std::vector<std::string_view>& types);

/// The same of a request that may go without the header; the first where it does.
/// @throws HttpProblem 406 that lists the types
std::size_t negotiated(const std::string& accept, const std::vector<std::string_view>& types);

}  // namespace cyanometer
