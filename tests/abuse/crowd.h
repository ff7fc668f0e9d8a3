// Many connections to one port, from one thread.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <vector>

namespace cyanometer::testing {

class Crowd {
 public:
  /// @param receive_bytes  of each socket's buffer; 0: the usual
  Crowd(int port, int count, int receive_bytes = 0) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < count; ++i) {
      const int one = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (one < 0) break;
      if (receive_bytes > 0) {
        setsockopt(one, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof(receive_bytes));
      }
      if (::connect(one, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
        ::close(one);
        break;
      }
      members_.push_back({.socket = one});
    }
  }
  ~Crowd() { leave(); }
  Crowd(const Crowd&) = delete;

  void send(const std::string& bytes) const {
    send_each([&](std::size_t) { return bytes; });
  }
  /// To the n-th what is made for it.
  template <class Make>
  void send_each(const Make& make) const {
    for (std::size_t n = 0; n < members_.size(); ++n) {
      const std::string bytes = make(n);
      (void)!::send(members_[n].socket, bytes.data(), bytes.size(),
                    MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }
  /// Each reads what is there, 16 KiB of it at the most.
  void sip() {
    std::array<char, 16384> bytes;
    for (Member& each : members_) {
      const auto got = ::recv(each.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (got > 0 && each.start.size() < 16)
        each.start.append(bytes.data(), std::min<std::size_t>(16, got));
      each.ended = each.ended || got == 0 || (got < 0 && errno != EAGAIN);
    }
  }
  /// Those that have read such a status and whose connection has not ended.
  std::size_t being_answered(int status) const {
    const std::string line = "HTTP/1.1 " + std::to_string(status);
    return static_cast<std::size_t>(std::ranges::count_if(members_, [&](const Member& each) {
      return !each.ended && each.start.starts_with(line);
    }));
  }
  void leave() {
    for (const Member& each : members_) ::close(each.socket);
    members_.clear();
  }
  std::size_t size() const { return members_.size(); }

 private:
  struct Member {
    int socket = -1;
    std::string start = {};  ///< of what it was answered
    bool ended = false;
  };
  std::vector<Member> members_;
};

}  // namespace cyanometer::testing
