#include "server/router.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/log.h"
#include "server/routes/page.h"
#include "server/routes/route.h"

namespace cyanometer {
namespace {

using Clock = std::chrono::steady_clock;

/// Named by the interface, not offered by this version.
constexpr std::array later_paths{"/v1/stream", "/v1/composite"};

constexpr int client_left = 499;  ///< in logs and metrics; nobody is there to read it

HttpProblem problem_of(const SceneError& error) {
  HttpProblem problem(400, error.what());
  problem.pointer = error.pointer;
  problem.given = error.given;
  problem.allowed = error.allowed;
  return problem;
}

HttpProblem problem_of(const OverLimit& limit) {
  HttpProblem problem(422, limit.what());
  problem.pointer = limit.pointer;
  return problem;
}

HttpProblem problem_of(const Cancelled& cancelled) {
  return cancelled.reason == Cancelled::Reason::deadline
             ? HttpProblem(504, "The deadline passed before the work was done.")
             : HttpProblem(client_left, "The client left.");
}

HttpProblem problem_of(const QueueFull& full) {
  HttpProblem problem(503, "The render queue is full.");
  problem.retry_after_s = full.retry_after_s;
  return problem;
}

HttpProblem no_device() {
  HttpProblem problem(503, "There is no device to render on.");
  problem.retry_after_s = 5;
  return problem;
}

/// The exception in flight as a problem; what it says of the inside is logged, never sent.
HttpProblem current_problem() {
  try {
    throw;
  } catch (const HttpProblem& problem) {
    return problem;
  } catch (const SceneError& error) {
    return problem_of(error);
  } catch (const OverLimit& limit) {
    return problem_of(limit);
  } catch (const Cancelled& cancelled) {
    return problem_of(cancelled);
  } catch (const QueueFull& full) {
    return problem_of(full);
  } catch (const DeviceUnavailable&) {
    return no_device();
  } catch (const std::exception& error) {
    log_event(spdlog::level::err, std::string("unexpected: ") + error.what());
  } catch (...) {
    log_event(spdlog::level::err, "unexpected: not an exception");
  }
  return HttpProblem(500, "Something went wrong inside the server; its log says more.");
}

Answer answer_of(const HttpProblem& problem, const std::string& id) {
  Answer answer;
  answer.status = problem.status;
  answer.headers = {{"Content-Type", "application/problem+json"},
                    {"Cache-Control", "no-store"}};
  if (problem.retry_after_s > 0) {
    answer.headers.emplace_back("Retry-After", std::to_string(problem.retry_after_s));
  }
  if (!problem.allow.empty()) answer.headers.emplace_back("Allow", problem.allow);
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
  if (const Route* route = find(request.method, request.path, ops_only_)) {
    return route->answer(request, service_);
  }
  const std::string allow = allowed_methods(request.path);
  if (allow.empty()) {
    const bool later = std::ranges::find(later_paths, request.path) != later_paths.end();
    throw HttpProblem(404,
                      later ? "This version does not offer " + request.path + " yet."
                            : "There is nothing here; GET /openapi.json lists what there is.");
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
  try {
    answer = dispatch(request);
  } catch (...) {
    answer = answer_of(current_problem(), request.id);
  }
  answer.headers.emplace_back("X-Content-Type-Options", "nosniff");
  answer.headers.emplace_back("X-Request-Id", request.id);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const std::string route = label(request);
  service_.metrics.answered(route, known_method(request.method), answer.status, seconds);
  const bool probe = route == "/healthz" || route == "/readyz" || route == "/metrics";
  log_line(probe ? spdlog::level::debug : spdlog::level::info, {{"id", request.id},
                                                                {"peer", request.peer},
                                                                {"method", request.method},
                                                                {"path", request.path},
                                                                {"status", answer.status},
                                                                {"ms", seconds * 1000},
                                                                {"bytes", answer.body.size()}});
  return answer;
}

Answer Router::refuse(const HttpProblem& problem, const std::string& peer) const {
  service_.metrics.answered("none", "other", problem.status, 0);
  log_line(spdlog::level::info,
           {{"peer", peer}, {"status", problem.status}, {"refused", problem.detail}});
  return answer_of(problem, "");
}

}  // namespace cyanometer
