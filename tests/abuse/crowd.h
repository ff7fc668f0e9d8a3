// Many connections to one port, from one thread.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

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
      sockets_.push_back(one);
    }
  }
  ~Crowd() { leave(); }
  Crowd(const Crowd&) = delete;

  void send(const std::string& bytes) const {
    for (const int one : sockets_) {
      (void)!::send(one, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }
  void leave() {
    for (const int one : sockets_) ::close(one);
    sockets_.clear();
  }
  std::size_t size() const { return sockets_.size(); }

 private:
  std::vector<int> sockets_;
};

}  // namespace cyanometer::testing
