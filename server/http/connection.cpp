#include "server/http/connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <utility>

#include "server/http/problem.h"

namespace cyanometer {
namespace {

std::string peer_address(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "unknown";
  const void* bytes = nullptr;
  if (address.ss_family == AF_INET) {
    bytes = &reinterpret_cast<const sockaddr_in*>(&address)->sin_addr;
  } else if (address.ss_family == AF_INET6) {
    bytes = &reinterpret_cast<const sockaddr_in6*>(&address)->sin6_addr;
  }
  if (bytes == nullptr || !inet_ntop(address.ss_family, bytes, text.data(), text.size())) {
    return "unknown";
  }
  return text.data();
}

int milliseconds_until(std::chrono::steady_clock::time_point deadline) {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 3600'000));
}

/// poll() that a signal does not end early.
int poll_until(std::span<pollfd> sockets, std::chrono::steady_clock::time_point deadline) {
  for (;;) {
    const int ready = ::poll(sockets.data(), sockets.size(), milliseconds_until(deadline));
    if (ready >= 0 || errno != EINTR) return ready;
  }
}

}  // namespace

bool BodyShare::grow_to(std::size_t body_bytes) {
  constexpr std::size_t free_bytes = std::size_t{1} << 20;
  const std::size_t wanted = std::max(body_bytes, free_bytes) - free_bytes;
  if (wanted <= bytes_) return true;
  const std::size_t more = wanted - bytes_;
  if (budget_->bytes.fetch_add(more) + more > budget_->most_bytes) {
    budget_->bytes -= more;
    return false;
  }
  bytes_ = wanted;
  return true;
}

Connection::Connection(int socket, int wake, const ConnectionLimits& limits)
    : socket_(socket), wake_(wake), limits_(limits), peer_(peer_address(socket)) {}

bool Connection::wait(std::chrono::milliseconds idle) {
  if (!buffer_.empty()) return true;
  std::array<pollfd, 2> both{{{socket_, POLLIN, 0}, {wake_, POLLIN, 0}}};
  if (poll_until(both, Clock::now() + idle) <= 0 || both[0].revents == 0) return false;
  return receive() && !buffer_.empty();
}

bool Connection::receive() {
  std::array<char, 16384> chunk;
  const auto got = ::recv(socket_, chunk.data(), chunk.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
  if (got <= 0) return false;
  buffer_.append(chunk.data(), static_cast<std::size_t>(got));
  return true;
}

bool Connection::fill(Clock::time_point deadline) {
  std::array<pollfd, 1> one{{{socket_, POLLIN, 0}}};
  if (Clock::now() >= deadline || poll_until(one, deadline) == 0) {
    throw HttpProblem(408, "The request did not arrive in time.");
  }
  return receive();
}

std::optional<std::string> Connection::read_head() {
  const auto deadline = Clock::now() + limits_.head;
  std::size_t searched = 0;
  for (;;) {
    // Empty lines before a request are the leftovers of old clients (RFC 9112, section 2.2).
    while (searched == 0 && buffer_.starts_with("\r\n")) buffer_.erase(0, 2);
    const auto end = buffer_.find("\r\n\r\n", searched);
    const auto size = end == std::string::npos ? buffer_.size() : end + 4;
    if (std::min(buffer_.find("\r\n"), size) > limits_.request_line_bytes) {
      throw HttpProblem(414, "The address is too long.");
    }
    if (size > limits_.head_bytes) throw HttpProblem(431, "The headers are too long.");
    if (end != std::string::npos) {
      std::string head = buffer_.substr(0, size);
      buffer_.erase(0, size);
      return head;
    }
    searched = buffer_.size() < 3 ? 0 : buffer_.size() - 3;
    if (!fill(deadline)) return std::nullopt;
  }
}

std::optional<Received> Connection::read() {
  const auto bytes = read_head();
  if (!bytes) return std::nullopt;
  const Head head = parse_head(*bytes);
  const Framing framing = frame_body(head, limits_.body_bytes);
  Received received{make_request(head), framing.close,
                    std::make_shared<BodyShare>(limits_.bodies)};
  if (framing.expect_continue && buffer_.empty()) write("HTTP/1.1 100 Continue\r\n\r\n");
  const auto deadline = Clock::now() + limits_.body;
  while (buffer_.size() < framing.body_bytes) {
    if (!fill(deadline)) return std::nullopt;
    if (received.body_share->grow_to(buffer_.size())) continue;
    HttpProblem problem(503, "The bodies of other requests take all the memory there is.");
    problem.retry_after_s = 1;
    throw problem;
  }
  std::string rest = buffer_.substr(framing.body_bytes);
  buffer_.resize(framing.body_bytes);
  received.request.body = std::exchange(buffer_, std::move(rest));
  received.request.peer = peer_;
  received.request.gone = [this] { return gone(); };
  return received;
}

bool Connection::write(std::string_view bytes) const {
  // Who drips would hold the answer's memory for as long as it likes.
  const auto slowest = Clock::now() + limits_.write +
                       std::chrono::seconds(bytes.size() / limits_.least_bytes_per_s);
  while (!bytes.empty()) {
    const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (sent < 0 && errno != EAGAIN && errno != EINTR) {
      return false;
    } else {
      const auto now = Clock::now();
      std::array<pollfd, 1> one{{{socket_, POLLOUT, 0}}};
      if (now >= slowest || poll_until(one, std::min(now + limits_.write, slowest)) <= 0) {
        return false;
      }
    }
  }
  return true;
}

bool Connection::gone() const {
  pollfd one{socket_, POLLRDHUP, 0};
  return ::poll(&one, 1, 0) > 0;
}

void Connection::close_gently() {
  ::shutdown(socket_, SHUT_WR);
  const auto deadline = Clock::now() + std::chrono::milliseconds(500);
  std::array<pollfd, 1> one{{{socket_, POLLIN, 0}}};
  std::array<char, 16384> chunk;
  for (int i = 0; i < 64 && poll_until(one, deadline) > 0; ++i) {
    if (::recv(socket_, chunk.data(), chunk.size(), MSG_DONTWAIT) <= 0) break;
  }
}

}  // namespace cyanometer
