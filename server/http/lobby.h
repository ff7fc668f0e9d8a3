// Connections whose threads wait for their clients; where threads are short one of them makes
// room.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <mutex>
#include <string>

namespace cyanometer {

class Lobby {
 public:
  /// A connection. It is here while something is waited for that its client does: that a
  /// request comes, whole, or at the end that it closes.
  class Guest {
   public:
    Guest(Lobby& lobby, int socket, std::string address);
    ~Guest() { leave(); }
    Guest(const Guest&) = delete;
    void enter();
    /// False where it was sent away: its thread is promised to another. That happens once.
    bool leave();

   private:
    friend Lobby;
    enum class State { outside, inside, sent_away };
    Lobby& lobby_;
    int socket_;
    std::string address_;
    State state_ = State::outside;
    std::uint64_t number_ = 0;  ///< in the order in which they came in
    std::list<Guest*>::iterator place_;
  };

  /// Of the address that has most guests here, the one that has waited longest and left nothing
  /// unread: its socket reads as closed from then on. Who would take all threads takes them
  /// from itself, therefore. False where there is none.
  bool send_one_away();

 private:
  void remove(const Guest& guest);

  std::mutex mutex_;
  std::uint64_t entered_ = 0;
  std::map<std::string, std::list<Guest*>> guests_;  ///< by address, who came first first
};

}  // namespace cyanometer
