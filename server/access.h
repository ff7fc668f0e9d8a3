// Who may ask, and whose pages may read the answers: the bearer token and CORS.
#pragma once

#include <string>

#include "server/config.h"
#include "server/http/message.h"

namespace cyanometer {

/// @throws HttpProblem 401 where the configuration asks for a token and the request brings
/// another or none
void check_token(const Request& request, const Config& config);

/// Whether two texts are equal, in a time that tells nothing of where they differ.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

/// What lets the pages of the configured origin read the answer (Fetch standard, section 3.2);
/// nothing where none is configured.
Fields cors_fields(const Request& request, const Config& config);

}  // namespace cyanometer
