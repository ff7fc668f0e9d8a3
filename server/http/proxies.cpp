#include "server/http/proxies.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace cyanometer {
namespace {

using Address = std::array<std::uint8_t, 16>;
constexpr int bits_before_ipv4 = 96;

std::optional<Address> parse_address(const std::string& text) {
  Address address{};
  if (inet_pton(AF_INET6, text.c_str(), address.data()) == 1) return address;
  address[10] = address[11] = 0xff;
  if (inet_pton(AF_INET, text.c_str(), address.data() + bits_before_ipv4 / 8) == 1) {
    return address;
  }
  return std::nullopt;
}

bool is_ipv4(const Address& address) {
  constexpr Address prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
  return std::equal(prefix.begin(), prefix.begin() + bits_before_ipv4 / 8, address.begin());
}

/// One text for an address however it was written.
std::string text_of(const Address& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (is_ipv4(address)) {
    inet_ntop(AF_INET, address.data() + bits_before_ipv4 / 8, text.data(), text.size());
  } else {
    inet_ntop(AF_INET6, address.data(), text.data(), text.size());
  }
  return text.data();
}

std::vector<std::string> elements(std::string_view list) {
  std::vector<std::string> out;
  while (!list.empty()) {
    const auto end = std::min(list.find(','), list.size());
    const auto element = list.substr(0, end);
    const auto first = std::min(element.find_first_not_of(" \t"), element.size());
    const auto last = element.find_last_not_of(" \t");
    out.emplace_back(element.substr(first, last - first + 1));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return out;
}

}  // namespace

Proxies::Proxies(const std::string& list) {
  for (const auto& element : elements(list)) networks_.push_back(parse(element));
}

Proxies::Network Proxies::parse(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  const auto address = parse_address(text.substr(0, slash));
  if (address) {
    const int most = is_ipv4(*address) ? 128 - bits_before_ipv4 : 128;
    int bits = most;
    if (slash < text.size()) {
      const char* end = text.data() + text.size();
      const auto read = std::from_chars(text.data() + slash + 1, end, bits);
      if (read.ec != std::errc{} || read.ptr != end) bits = -1;
    }
    if (bits >= 0 && bits <= most) return {*address, 128 - most + bits};
  }
  throw std::runtime_error("--trusted-proxy: '" + text +
                           "' is no address or network such as 127.0.0.1 or 10.0.0.0/8");
}

bool Proxies::trust(const Address& address) const {
  return std::ranges::any_of(networks_, [&](const Network& network) {
    for (int bit = 0; bit < network.bits; ++bit) {
      const auto byte = static_cast<std::size_t>(bit / 8);
      if ((network.address[byte] ^ address[byte]) & (0x80 >> bit % 8)) return false;
    }
    return true;
  });
}

std::string Proxies::client(const std::string& peer, const std::string& forwarded_for) const {
  if (networks_.empty()) return peer;
  auto address = parse_address(peer);
  if (!address) return peer;
  const auto hops = elements(forwarded_for);
  for (auto hop = hops.rbegin(); hop != hops.rend() && trust(*address); ++hop) {
    const auto before = parse_address(*hop);
    if (!before) break;
    address = before;
  }
  return text_of(*address);
}

}  // namespace cyanometer
