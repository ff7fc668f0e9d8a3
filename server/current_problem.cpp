#include "server/current_problem.h"

#include <new>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/log.h"

namespace cyanometer {
namespace {

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

HttpProblem no_memory(const char* what) {
  log_event(spdlog::level::err, std::string("out of memory: ") + what);
  HttpProblem problem(503, "There is no memory for this now.");
  problem.retry_after_s = 5;
  return problem;
}

HttpProblem no_device() {
  HttpProblem problem(503, "There is no device to render on.");
  problem.retry_after_s = 5;
  return problem;
}

}  // namespace

HttpProblem problem_of(const QueueFull& full) {
  const bool client = full.whose == QueueFull::Whose::client;
  HttpProblem problem(client ? 429 : 503, client ? "Too many requests of this client wait."
                                                 : "The render queue is full.");
  problem.retry_after_s = full.retry_after_s;
  return problem;
}

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
  } catch (const OutOfDeviceMemory& none) {
    return no_memory(none.what());
  } catch (const std::bad_alloc& none) {
    return no_memory(none.what());
  } catch (const std::exception& error) {
    log_event(spdlog::level::err, std::string("unexpected: ") + error.what());
  } catch (...) {
    log_event(spdlog::level::err, "unexpected: not an exception");
  }
  return HttpProblem(500, "Something went wrong inside the server; its log says more.");
}

}  // namespace cyanometer
