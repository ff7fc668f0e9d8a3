// See client.h.
#include "tests/api/client.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

namespace cyanometer::testing {

using namespace std::chrono_literals;

Config free_port() {
  Config config;
  config.listen = "127.0.0.1:0";
  config.warm = false;
  return config;
}

Daemon& shared_daemon() {
  static Daemon& daemon = []() -> Daemon& {
    ConnectionLimits limits;
    limits.head = 500ms;
    limits.body = 500ms;
    static Daemon made(free_port(), limits);
    made.start();
    wait_until_ready(made);
    return made;
  }();
  return daemon;
}

void wait_until_ready(Daemon& daemon) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!daemon.service().ready() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_TRUE(daemon.service().ready());
}

void wait_until_still(const RenderQueue& queue, std::uint64_t done_before) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  std::uint64_t done = done_before;
  for (int still = 0; still < 10; ++still) {
    std::this_thread::sleep_for(100ms);
    const auto now = queue.counts().done;
    if (now != std::exchange(done, now) || now == done_before) still = 0;
    ASSERT_LT(std::chrono::steady_clock::now(), end);
  }
}

httplib::Client client_of(const Daemon& daemon) {
  httplib::Client client("127.0.0.1", daemon.port());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  // A first frame compiles its kernels, on slow machines for more than a minute.
  client.set_read_timeout(300);
  return client;
}

httplib::Client client() { return client_of(shared_daemon()); }

nlohmann::json small_scene() { return {{"image", {{"width", 16}, {"height", 8}}}}; }

nlohmann::json tiny_scene() {
  return {{"image", {{"width", 16}, {"height", 8}}},
          {"method", {{"name", "raymarch"}, {"scattering_orders", 1}}}};
}

nlohmann::json long_scene() {
  return {{"method", {{"name", "nishita"}, {"view_samples", 1000}, {"light_samples", 500}}},
          {"image", {{"width", 512}, {"height", 512}}}};
}

const std::string large_link =
    "image.width=512&image.height=512&image.format=npy&method.name=raymarch&method.view_nodes="
    "1";

RawClient::RawClient(int port, const std::string& from, int receive_bytes)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_bytes > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof(receive_bytes));
  }
  sockaddr_in here{}, there{};
  here.sin_family = there.sin_family = AF_INET;
  EXPECT_EQ(inet_pton(AF_INET, from.c_str(), &here.sin_addr), 1);
  EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&here), sizeof(here)), 0);
  there.sin_port = htons(static_cast<std::uint16_t>(port));
  there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&there), sizeof(there)), 0);
}

RawClient::~RawClient() { close(); }

void RawClient::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void RawClient::send(const std::string& bytes) {
  // The server may have refused and closed already: then its answer is what is of interest.
  (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

bool RawClient::receive_some(std::string& into, std::chrono::milliseconds patience) {
  pollfd one{socket_, POLLIN, 0};
  if (::poll(&one, 1, static_cast<int>(patience.count())) <= 0) return false;
  std::array<char, 65536> chunk;
  const auto got = ::recv(socket_, chunk.data(), chunk.size(), 0);
  if (got <= 0) return false;
  into.append(chunk.data(), static_cast<std::size_t>(got));
  return true;
}

std::string RawClient::receive(std::chrono::milliseconds patience) {
  std::string all = std::move(rest_);
  rest_.clear();
  while (receive_some(all, patience)) {
  }
  return all;
}

std::string RawClient::sip(std::size_t bytes) {
  pollfd one{socket_, POLLIN, 0};
  std::string sipped(bytes, ' ');
  const auto got = ::poll(&one, 1, 3000) > 0 ? ::recv(socket_, sipped.data(), bytes, 0) : 0;
  sipped.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return sipped;
}

std::string RawClient::receive_one() {
  const std::string field = "Content-Length: ";
  for (;;) {
    const auto head = rest_.find("\r\n\r\n");
    const auto length = rest_.find(field);
    if (head != std::string::npos && length < head) {
      const auto end = head + 4 + std::stoul(rest_.substr(length + field.size()));
      if (rest_.size() >= end) {
        const std::string one = rest_.substr(0, end);
        rest_.erase(0, end);
        return one;
      }
    }
    if (!receive_some(rest_, 10s)) return std::exchange(rest_, "");
  }
}

std::string exchange(const std::string& bytes) {
  RawClient raw;
  raw.send(bytes);
  return raw.receive();
}

std::string get_if_changed(const std::string& target, const std::string& tag) {
  return exchange("GET " + target + " HTTP/1.1\r\nHost: here\r\nIf-None-Match: " + tag +
                  "\r\nConnection: close\r\n\r\n");
}

int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

nlohmann::json json_of(const httplib::Result& answer) {
  EXPECT_TRUE(answer);
  return answer ? nlohmann::json::parse(answer->body) : nlohmann::json();
}

}  // namespace cyanometer::testing
