#include "server/router.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "server/access.h"
#include "server/current_problem.h"
#include "server/log.h"
#include "server/routes/page.h"
#include "server/routes/route.h"

namespace cyanometer {
namespace {

using Clock = std::chrono::steady_clock;

Answer answer_of(const HttpProblem& problem, const std::string& id) {
  Answer answer;
  answer.status = problem.status;
  answer.headers = {{"Content-Type", "application/problem+json"},
                    {"Cache-Control", "no-store"}};
  if (problem.retry_after_s > 0) {
    answer.headers.emplace_back("Retry-After", std::to_string(problem.retry_after_s));
  }
  if (!problem.allow.empty()) answer.headers.emplace_back("Allow", problem.allow);
  if (!problem.authenticate.empty()) {
    answer.headers.emplace_back("WWW-Authenticate", problem.authenticate);
  }
  answer.body = problem_json(problem, id);
  return answer;
}

/// Few names, whatever clients send: they become labels of metrics.
std::string known_method(const std::string& method) {
  constexpr std::array known{"GET", "HEAD", "POST", "OPTIONS"};
  return std::ranges::find(known, method) == known.end() ? "other" : method;
}

const Route* find(const std::string& method, const std::string& path, bool ops_only) {
  const std::string& wanted_path = is_page_file(path) ? "/" : path;
  const std::string& wanted_method = method == "HEAD" ? "GET" : method;
  for (const Route& route : routes()) {
    if (route.path == wanted_path && route.method == wanted_method &&
        (route.ops || !ops_only)) {
      return &route;
    }
  }
  return nullptr;
}

bool is_probe(const std::string& path) { return path == "/healthz" || path == "/readyz"; }

}  // namespace

std::string Router::allowed_methods(const std::string& path) const {
  std::string out;
  if (find("GET", path, ops_only_)) out += "GET, HEAD, ";
  if (find("POST", path, ops_only_)) out += "POST, ";
  return out.empty() ? out : out + "OPTIONS";
}

Answer Router::dispatch(const Request& request) const {
  if (request.method == "OPTIONS" && request.path == "*") {
    return {.status = 204, .headers = {{"Allow", "GET, HEAD, POST, OPTIONS"}}};
  }
  // Browsers ask beforehand without it, and probes have none; the operators' port is their own.
  const bool open = request.method == "OPTIONS" || is_probe(request.path) || ops_only_;
  if (!open) check_token(request, service_.config);
  if (const Route* route = find(request.method, request.path, ops_only_)) {
    return route->answer(request, service_);
  }
  const std::string allow = allowed_methods(request.path);
  if (allow.empty()) {
    throw HttpProblem(404, "There is nothing here; GET /openapi.json lists what there is.");
  }
  if (request.method == "OPTIONS") return {.status = 204, .headers = {{"Allow", allow}}};
  HttpProblem problem(405, "This address takes " + allow + ".");
  problem.allow = allow;
  throw problem;
}

std::string Router::label(const Request& request) const {
  if (is_page_file(request.path)) return "/";
  return allowed_methods(request.path).empty() ? "none" : request.path;
}

Answer Router::answer(const Request& request) const {
  const auto start = Clock::now();
  Answer answer;
  bool logged = true;
  try {
    answer = dispatch(request);
  } catch (const QueueFull& full) {
    ++service_.turned_away;
    logged = service_.refusals.next();
    answer = answer_of(problem_of(full), request.id);
  } catch (...) {
    answer = answer_of(current_problem(), request.id);
  }
  answer.headers.emplace_back("X-Content-Type-Options", "nosniff");
  answer.headers.emplace_back("X-Request-Id", request.id);
  for (auto& field : cors_fields(request, service_.config)) {
    answer.headers.push_back(std::move(field));
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const std::string route = label(request);
  service_.metrics.answered(route, known_method(request.method), answer.status, seconds);
  if (!logged) return answer;
  const bool probe = is_probe(route) || route == "/metrics";
  log_line(probe ? spdlog::level::debug : spdlog::level::info,
           {{"id", request.id},
            {"peer", request.peer},
            {"method", request.method},
            {"path", request.path},
            {"status", answer.status},
            {"ms", seconds * 1000},
            {"bytes", answer.content().size()}});
  return answer;
}

Answer Router::refuse(const HttpProblem& problem, const std::string& peer) const {
  service_.metrics.answered("none", "other", problem.status, 0);
  log_line(spdlog::level::info,
           {{"peer", peer}, {"status", problem.status}, {"refused", problem.detail}});
  return answer_of(problem, "");
}

}  // namespace cyanometer
