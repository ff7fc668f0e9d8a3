// Errors as RFC 9457 problem documents; thrown where a request cannot be answered.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace cyanometer {

struct HttpProblem : std::exception {
  int status = 500;
  std::string detail;        ///< for people: what is wrong with this request
  std::string pointer;       ///< RFC 6901, into the request's body; empty: not about one member
  std::string given;         ///< what stands there, as JSON, shortened
  std::string allowed;       ///< in words
  int retry_after_s = 0;     ///< sent as Retry-After where positive
  std::string allow;         ///< sent as Allow where not empty
  std::string authenticate;  ///< sent as WWW-Authenticate where not empty

  HttpProblem(int status_, std::string detail_) : status(status_), detail(std::move(detail_)) {}
  const char* what() const noexcept override { return detail.c_str(); }
};

/// The phrase RFC 9110 gives a status: "Not Found".
std::string_view status_phrase(int status);

/// The problem as bytes of application/problem+json; `request_id` is its instance.
std::string problem_json(const HttpProblem& problem, std::string_view request_id);

}  // namespace cyanometer
