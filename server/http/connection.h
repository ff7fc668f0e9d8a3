// One client's connection: whole requests in, answers out, each within a byte budget and a
// deadline.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "server/http/message.h"

namespace cyanometer {

/// What the long bodies of all requests that are being read or answered may take together.
struct BodyBudget {
  std::size_t most_bytes = std::size_t{1} << 30;
  std::atomic<std::size_t> bytes{0};
};

/// A body's share of the budget: what has come of it beyond a MiB, so that neither short bodies
/// nor long ones that are only announced take anything.
class BodyShare {
 public:
  explicit BodyShare(std::shared_ptr<BodyBudget> budget) : budget_(std::move(budget)) {}
  ~BodyShare() { budget_->bytes -= bytes_; }
  BodyShare(const BodyShare&) = delete;
  /// False where there is no room for so much.
  bool grow_to(std::size_t body_bytes);

 private:
  std::shared_ptr<BodyBudget> budget_;
  std::size_t bytes_ = 0;
};

struct ConnectionLimits {
  using Duration = std::chrono::milliseconds;
  std::size_t request_line_bytes = 8192;
  std::size_t head_bytes = 32768;
  std::size_t body_bytes = std::size_t{4} << 20;
  std::shared_ptr<BodyBudget> bodies = std::make_shared<BodyBudget>();
  int requests = 10000;                       ///< on one connection
  Duration idle = std::chrono::seconds(75);   ///< between requests
  Duration head = std::chrono::seconds(10);   ///< from a head's first byte to its last
  Duration body = std::chrono::seconds(30);   ///< for a whole body
  Duration write = std::chrono::seconds(20);  ///< without a byte taken by the client
  std::size_t least_bytes_per_s = 32768;      ///< taken by it, of what is written at once
};

/// A request as it came in, and whether the connection must end with its answer.
struct Received {
  Request request;
  bool close = false;
  std::shared_ptr<BodyShare> body_share = {};
};

/// Does not own the socket.
class Connection {
 public:
  /// `wake` becomes readable when the server stops: idle connections then end at once.
  Connection(int socket, int wake, const ConnectionLimits& limits);

  /// True when a request's first byte is there; false when the client left, `idle` went by, or
  /// the server stops.
  bool wait(std::chrono::milliseconds idle);
  /// The next request, whole; none when the client left in the middle of it.
  /// @throws HttpProblem; the connection must then be closed, its place in the stream is
  /// unknown
  std::optional<Received> read();
  /// False when the client did not take it all, or took it too slowly.
  bool write(std::string_view bytes) const;
  bool gone() const;
  /// Sends what is written and lets the client read it: closing a socket with unread input
  /// would reset the connection and lose the answer.
  void close_gently();

  int socket() const { return socket_; }
  const std::string& peer() const { return peer_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits for more. False when the client left. @throws HttpProblem past the deadline
  bool fill(Clock::time_point deadline);
  /// What is there. False when the client left.
  bool receive();
  std::optional<std::string> read_head();

  int socket_;
  int wake_;
  const ConnectionLimits& limits_;
  std::string peer_;
  std::string buffer_;  ///< received and not yet part of a request
};

}  // namespace cyanometer
