// Whose request it is behind a reverse proxy.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cyanometer {

/// The addresses that are believed when they say for whom they ask.
class Proxies {
 public:
  Proxies() = default;
  /// Addresses and networks, as "127.0.0.1,10.0.0.0/8,::1"; none where empty.
  /// @throws std::runtime_error that names what is no address
  explicit Proxies(const std::string& list);

  /// The last address of X-Forwarded-For that is not itself a proxy's, where the peer is one:
  /// what stands before it is the client's own word. The peer's where there is none.
  std::string client(const std::string& peer, const std::string& forwarded_for) const;

 private:
  /// IPv4 as the IPv6 addresses that stand for it, ::ffff:a.b.c.d.
  struct Network {
    std::array<std::uint8_t, 16> address;
    int bits;
  };
  static Network parse(const std::string& text);
  bool trust(const std::array<std::uint8_t, 16>& address) const;

  std::vector<Network> networks_;
};

}  // namespace cyanometer
