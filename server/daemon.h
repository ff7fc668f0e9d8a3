// The daemon: the service behind its listeners.
#pragma once

#include <memory>
#include <thread>

#include "server/http/http_server.h"
#include "server/router.h"
#include "server/service.h"

namespace cyanometer {

class Daemon {
 public:
  /// Binds; the engine is made meanwhile. @throws std::runtime_error where an address is taken
  explicit Daemon(const Config& config, const ConnectionLimits& limits = {});
  ~Daemon();

  void start();
  /// Not ready, then no longer listening; returns when what was in flight is finished.
  void stop();

  int port() const { return main_.port(); }
  int ops_port() const { return ops_ ? ops_->port() : 0; }
  Service& service() { return service_; }
  /// True when the process should end with an error: no device, or no connections any more.
  bool failed() const { return service_.queue.failed() || listener_failed_; }

 private:
  void run(HttpServer& server);

  Service service_;
  Router router_, ops_router_;
  HttpServer main_;
  std::unique_ptr<HttpServer> ops_;
  std::atomic<bool> listener_failed_{false};
  std::thread main_thread_, ops_thread_;
};

}  // namespace cyanometer
