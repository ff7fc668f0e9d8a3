#include "server/http/lobby.h"

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

namespace cyanometer {
namespace {

/// Its thread has only not come to it yet.
bool has_unread(int socket) {
  int bytes = 0;
  return ::ioctl(socket, FIONREAD, &bytes) == 0 && bytes > 0;
}

}  // namespace

Lobby::Guest::Guest(Lobby& lobby, int socket, std::string address)
    : lobby_(lobby), socket_(socket), address_(std::move(address)) {}

void Lobby::Guest::enter() {
  const std::lock_guard lock(lobby_.mutex_);
  if (state_ != State::outside) return;
  state_ = State::inside;
  number_ = lobby_.entered_++;
  auto& others = lobby_.guests_[address_];
  place_ = others.insert(others.end(), this);
}

bool Lobby::Guest::leave() {
  const std::lock_guard lock(lobby_.mutex_);
  if (state_ == State::inside) {
    lobby_.remove(*this);
    state_ = State::outside;
  }
  return state_ == State::outside;
}

void Lobby::remove(const Guest& guest) {
  const auto of_address = guests_.find(guest.address_);
  of_address->second.erase(guest.place_);
  if (of_address->second.empty()) guests_.erase(of_address);
}

bool Lobby::send_one_away() {
  const std::lock_guard lock(mutex_);
  const auto most = std::ranges::max_element(guests_, {}, [](const auto& of_address) {
    const auto& guests = of_address.second;
    return std::pair(guests.size(), ~guests.front()->number_);
  });
  if (most == guests_.end()) return false;
  const auto found = std::ranges::find_if(
      most->second, [](const Guest* guest) { return !has_unread(guest->socket_); });
  if (found == most->second.end()) return false;
  Guest& guest = **found;
  remove(guest);
  guest.state_ = Guest::State::sent_away;
  ::shutdown(guest.socket_, SHUT_RD);
  return true;
}

}  // namespace cyanometer
