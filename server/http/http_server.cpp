#include "server/http/http_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <new>
#include <stdexcept>
#include <thread>

#include "server/http/thread_pool.h"

namespace cyanometer {
namespace {

std::pair<std::string, int> split_address(const std::string& address) {
  const auto colon = address.rfind(':');
  int port = -1;
  if (colon != std::string::npos) {
    const char* end = address.data() + address.size();
    if (std::from_chars(address.data() + colon + 1, end, port).ptr != end) port = -1;
  }
  if (port < 0 || port > 65535) {
    throw std::runtime_error("'" + address + "' is not an address such as 127.0.0.1:8080");
  }
  std::string host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host.empty() ? "0.0.0.0" : host, port};
}

int bound_port(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

/// Without SO_REUSEPORT: a second daemon on the same port must fail, not share it.
void set_options(socket_t socket) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
}

HttpProblem too_many_connections() {
  HttpProblem problem(503, "Too many connections.");
  problem.retry_after_s = 1;
  return problem;
}

}  // namespace

HttpServer::HttpServer(Options options, Handlers handlers)
    : options_(std::move(options)),
      handlers_(std::move(handlers)),
      wake_(eventfd(0, EFD_CLOEXEC)) {
  set_socket_options(set_options);
}

HttpServer::~HttpServer() {
  ::close(wake_);
  if (svr_sock_ >= 0) ::close(svr_sock_);
}

void HttpServer::bind(const std::string& address) {
  const auto [host, port] = split_address(address);
  const bool bound = port == 0 ? bind_to_any_port(host) > 0 : bind_to_port(host, port);
  constexpr int backlog = 1024;  // the library's is 5: a burst of clients would be dropped
  if (!bound || ::listen(svr_sock_, backlog) != 0) {
    throw std::runtime_error("cannot listen on " + address +
                             " (in use, or not this machine's)");
  }
  port_ = bound_port(svr_sock_);
}

bool HttpServer::run() {
  ThreadPool pool(options_.connections, options_.nice);
  bool listening = true;
  while (listening && !stopping_) {
    const int socket = ::accept4(svr_sock_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket >= 0) {
      admit(socket, pool);
    } else if (errno == EINVAL || errno == EBADF || errno == ENOTSOCK) {
      listening = false;  // stop() makes it EINVAL
    } else {
      // A client that has left again, or no descriptor or memory for it now: that passes, and
      // the library would end here.
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  pool.shutdown();
  return stopping_;
}

void HttpServer::stop() {
  if (stopping_.exchange(true)) return;
  eventfd_write(wake_, 1);
  // A socket that is shut down never accepts.
  const int listener = svr_sock_;
  if (listener >= 0) ::shutdown(listener, SHUT_RDWR);
}

void HttpServer::admit(int socket, ThreadPool& pool) {
  const auto task = [this, socket] { serve_and_close(socket); };
  if (pool.start(task)) return;
  if (lobby_.send_one_away()) {
    pool.queue(task);
  } else {
    refuse_and_close(socket);
  }
}

void HttpServer::serve_and_close(int socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  // Of a buffer of MiB the system would say for long that no byte was taken, of a slow reader.
  const int unsent_bytes = 131072;
  setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent_bytes, sizeof(unsent_bytes));
  Connection connection(socket, wake_, options_.limits);
  ++connections_;
  try {
    serve(connection);
  } catch (const std::bad_alloc&) {
    // There is no memory to read it into, nor to say so: the connection ends.
  }
  --connections_;
  ::close(socket);
}

void HttpServer::refuse_and_close(int socket) {
  Connection connection(socket, wake_, options_.limits);
  refuse(connection, too_many_connections());
  ::close(socket);
}

void HttpServer::serve(Connection& connection) {
  const auto& limits = options_.limits;
  Lobby::Guest guest(lobby_, connection.socket(), connection.peer());
  for (int left = limits.requests; left > 0; --left) {
    guest.enter();
    if (!connection.wait(left == limits.requests ? limits.head : limits.idle)) return;
    if (!serve_one(connection, guest, left == 1)) break;
  }
  guest.enter();
  connection.close_gently();
}

bool HttpServer::serve_one(Connection& connection, Lobby::Guest& guest, bool last) {
  try {
    auto received = connection.read();
    if (!guest.leave()) throw too_many_connections();
    if (!received) return false;
    auto& request = received->request;
    request.peer = options_.proxies.client(request.peer, request.header("x-forwarded-for"));
    const Answer answer = handlers_.answer(request);
    const bool close = received->close || last || stopping_ || answer.stream;
    return send(connection, answer, request.method == "HEAD", close) && !close;
  } catch (const HttpProblem& problem) {
    refuse(connection, problem);
    return false;
  }
}

void HttpServer::refuse(Connection& connection, const HttpProblem& problem) const {
  send(connection, handlers_.refuse(problem, connection.peer()), false, true);
}

bool HttpServer::send(const Connection& connection, const Answer& answer, bool head_only,
                      bool close) {
  std::string head = serialise_head(answer, close);
  if (!has_body(answer, head_only)) return connection.write(head);
  if (answer.stream) {
    if (!connection.write(head)) return false;
    answer.stream([&](std::string_view bytes) { return connection.write(bytes); });
    return true;
  }
  // What is short goes in one packet with its head; what is long is not copied.
  constexpr std::size_t short_bytes = 16384;
  const auto content = answer.content();
  if (content.size() <= short_bytes) return connection.write(head.append(content));
  return connection.write(head) && connection.write(content);
}

}  // namespace cyanometer
