#include "server/http/problem.h"

#include <map>
#include <nlohmann/json.hpp>

namespace cyanometer {

std::string_view status_phrase(int status) {
  static const std::map<int, std::string_view> phrases{
      {100, "Continue"},
      {200, "OK"},
      {204, "No Content"},
      {304, "Not Modified"},
      {400, "Bad Request"},
      {401, "Unauthorized"},
      {404, "Not Found"},
      {405, "Method Not Allowed"},
      {406, "Not Acceptable"},
      {408, "Request Timeout"},
      {411, "Length Required"},
      {413, "Content Too Large"},
      {414, "URI Too Long"},
      {415, "Unsupported Media Type"},
      {417, "Expectation Failed"},
      {422, "Unprocessable Content"},
      {429, "Too Many Requests"},
      {431, "Request Header Fields Too Large"},
      {499, "Client Closed Request"},
      {500, "Internal Server Error"},
      {503, "Service Unavailable"},
      {504, "Gateway Timeout"},
      {505, "HTTP Version Not Supported"},
  };
  const auto found = phrases.find(status);
  return found == phrases.end() ? "Unknown" : found->second;
}

std::string problem_json(const HttpProblem& problem, std::string_view request_id) {
  nlohmann::ordered_json out{{"type", "about:blank"},
                             {"title", status_phrase(problem.status)},
                             {"status", problem.status},
                             {"detail", problem.detail}};
  if (!request_id.empty())
    out["instance"] = "urn:cyanometer:request:" + std::string(request_id);
  if (!problem.pointer.empty()) out["pointer"] = problem.pointer;
  if (!problem.given.empty()) out["given"] = problem.given;
  if (!problem.allowed.empty()) out["allowed"] = problem.allowed;
  if (problem.retry_after_s > 0) out["retry_after_s"] = problem.retry_after_s;
  // What was given may hold broken UTF-8; an error about it must still be sent.
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace cyanometer
