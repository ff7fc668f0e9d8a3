// The guarded listener: cpp-httplib binds, everything after that is done here.
#pragma once

#include <httplib.h>

#include <atomic>
#include <functional>
#include <string>

#include "server/http/connection.h"
#include "server/http/lobby.h"
#include "server/http/message.h"
#include "server/http/problem.h"
#include "server/http/proxies.h"

namespace cyanometer {

class ThreadPool;

class HttpServer : private httplib::Server {
 public:
  struct Options {
    ConnectionLimits limits;
    Proxies proxies = {};
    std::size_t connections = 512;  ///< at once, each with a thread
    int nice = 0;                   ///< of those threads, added to the process's
  };
  struct Handlers {
    /// Must not throw.
    std::function<Answer(const Request&)> answer;
    /// The answer to what could not be read as a request.
    std::function<Answer(const HttpProblem&, const std::string& peer)> refuse;
  };

  HttpServer(Options options, Handlers handlers);
  ~HttpServer() override;

  /// Binds to "host:port", "[v6]:port" or ":port"; port 0 takes any free one.
  /// @throws std::runtime_error
  void bind(const std::string& address);
  int port() const { return port_; }
  /// Accepts until stop(), then finishes what is in flight. False when there is nothing to
  /// accept from any more.
  bool run();
  /// From any thread, before, during or after run().
  void stop();

  int connections() const { return connections_; }

 private:
  /// Where all threads are taken, one that waits for its client is taken from it.
  void admit(int socket, ThreadPool& pool);
  void serve_and_close(int socket);
  void refuse_and_close(int socket);
  void serve(Connection& connection);
  /// True when one more request may be waited for.
  bool serve_one(Connection& connection, Lobby::Guest& guest, bool last);
  void refuse(Connection& connection, const HttpProblem& problem) const;
  /// False when the client did not take it all.
  static bool send(const Connection& connection, const Answer& answer, bool head_only,
                   bool close);

  Options options_;
  Handlers handlers_;
  std::atomic<bool> stopping_{false};
  std::atomic<int> connections_{0};
  Lobby lobby_;
  int wake_ = -1;  ///< eventfd, readable once stopping
  int port_ = 0;
};

}  // namespace cyanometer
