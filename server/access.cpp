#include "server/access.h"

#include <algorithm>

#include "server/http/problem.h"

namespace cyanometer {

bool equal_in_constant_time(const std::string& given, const std::string& secret) {
  std::size_t difference = given.size() ^ secret.size();
  // Over the given text alone: how long it takes says nothing of the secret.
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = secret.empty() ? '\0' : secret[i % secret.size()];
    difference |= static_cast<unsigned char>(given[i] ^ other);
  }
  return difference == 0;
}

void check_token(const Request& request, const Config& config) {
  if (config.token.empty()) return;
  const std::string given = request.header("authorization");
  constexpr std::string_view scheme = "bearer ";  // in any case (RFC 9110, section 11.1)
  const bool bearer = std::ranges::equal(
      std::string_view(given).substr(0, scheme.size()), scheme, {},
      [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
  if (bearer && equal_in_constant_time(given.substr(scheme.size()), config.token)) {
    return;
  }
  HttpProblem problem(401, given.empty() ? "This server asks for a bearer token."
                                         : "That is not this server's bearer token.");
  problem.authenticate = "Bearer";
  throw problem;
}

Fields cors_fields(const Request& request, const Config& config) {
  if (config.cors_origin.empty()) return {};
  const bool any = config.cors_origin == "*";
  Fields fields;
  if (!any) fields.emplace_back("Vary", "Origin");
  const std::string origin = request.header("origin");
  if (origin.empty() || (!any && origin != config.cors_origin)) return fields;
  fields.emplace_back("Access-Control-Allow-Origin", config.cors_origin);
  if (request.method == "OPTIONS") {
    fields.emplace_back("Access-Control-Allow-Methods", "GET, HEAD, POST, OPTIONS");
    fields.emplace_back("Access-Control-Allow-Headers",
                        "Authorization, Content-Type, Cyanometer-Atmosphere, "
                        "Cyanometer-Deadline, If-None-Match, X-Request-Id");
    fields.emplace_back("Access-Control-Max-Age", "600");
  } else {
    fields.emplace_back("Access-Control-Expose-Headers", "*");
  }
  return fields;
}

}  // namespace cyanometer
