#include "server/daemon.h"

#include <algorithm>

namespace cyanometer {
namespace {

constexpr std::size_t ops_connections = 32;
/// Where the device is the processor itself, whoever is turned away must not keep a frame
/// waiting: a dispatch ends with the last of its threads, and hands on to the next step.
constexpr int clients_nice = 5;

HttpServer::Options options(const Config& config, ConnectionLimits limits) {
  limits.body_bytes = config.body_bytes();
  limits.bodies = std::make_shared<BodyBudget>();
  limits.bodies->most_bytes = std::max(config.frame_bytes(), config.body_bytes());
  return {.limits = limits,
          .proxies = Proxies(config.trusted_proxy),
          .connections = static_cast<std::size_t>(config.threads),
          .nice = clients_nice};
}

HttpServer::Handlers handlers(const Router& router) {
  return {[&router](const Request& request) { return router.answer(request); },
          [&router](const HttpProblem& problem, const std::string& peer) {
            return router.refuse(problem, peer);
          }};
}

}  // namespace

Daemon::Daemon(const Config& config, const ConnectionLimits& limits)
    : service_(config),
      router_(service_, false),
      ops_router_(service_, true),
      main_(options(config, limits), handlers(router_)) {
  main_.bind(config.listen);
  service_.connections = [this] { return main_.connections(); };
  if (config.ops_listen.empty()) return;
  auto ops_options = options(config, limits);
  ops_options.connections = ops_connections;
  ops_options.nice = 0;  // probes have their time to be answered in
  ops_ = std::make_unique<HttpServer>(ops_options, handlers(ops_router_));
  ops_->bind(config.ops_listen);
}

Daemon::~Daemon() { stop(); }

void Daemon::start() {
  main_thread_ = std::thread([this] { run(main_); });
  if (ops_) ops_thread_ = std::thread([this] { run(*ops_); });
}

void Daemon::run(HttpServer& server) {
  if (!server.run()) listener_failed_ = true;
}

void Daemon::stop() {
  if (!service_.draining.exchange(true) && main_thread_.joinable()) {
    std::this_thread::sleep_for(std::chrono::duration<double>(service_.config.drain_s));
  }
  main_.stop();
  if (main_thread_.joinable()) main_thread_.join();
  // Probes are answered until the last request is.
  if (ops_) ops_->stop();
  if (ops_thread_.joinable()) ops_thread_.join();
}

}  // namespace cyanometer
