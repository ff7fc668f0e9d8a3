// What the API tests share: a daemon in this process, and a client that can misbehave.
#pragma once

#include <httplib.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "server/daemon.h"

namespace cyanometer::testing {

/// The daemon that most tests talk to, made once; its head and body deadlines are half a
/// second.
Daemon& shared_daemon();

/// A daemon's configuration on a free port.
Config free_port();
/// Waits until the engine is there. Fails the test after a minute.
void wait_until_ready(Daemon& daemon);
/// Waits until jobs have been done since then, and for a second no more.
void wait_until_still(const RenderQueue& queue, std::uint64_t done_before);

httplib::Client client_of(const Daemon& daemon);
httplib::Client client();  ///< of the shared daemon

/// A scene of 16 x 8 pixels.
nlohmann::json small_scene();
/// The same of which few kernels are needed: each program that renders it starts in a fifth of
/// the time.
nlohmann::json tiny_scene();
/// A scene that takes minutes.
nlohmann::json long_scene();
/// A link's scene of 3 MB, soon made: few of them fill the buffers between here and there.
extern const std::string large_link;

/// A connection on which any bytes can be sent.
class RawClient {
 public:
  /// @param from           an address of this machine
  /// @param receive_bytes  of its buffer; 0: the usual
  explicit RawClient(int port, const std::string& from = "127.0.0.1", int receive_bytes = 0);
  RawClient() : RawClient(shared_daemon().port()) {}
  ~RawClient();
  RawClient(const RawClient&) = delete;

  void send(const std::string& bytes);
  /// All that comes until the server closes or says nothing for so long.
  std::string receive(std::chrono::milliseconds patience = std::chrono::seconds(3));
  /// So many bytes at the most; none when the server closes, or says nothing for 3 s.
  std::string sip(std::size_t bytes);
  /// One answer with a Content-Length.
  std::string receive_one();
  void close();

 private:
  bool receive_some(std::string& into, std::chrono::milliseconds patience);
  int socket_;
  std::string rest_;
};

/// Sends, and returns all that is answered until the connection closes.
std::string exchange(const std::string& bytes);
/// The library's client waits for a body after 304, so this is done by hand.
std::string get_if_changed(const std::string& target, const std::string& tag);
int status_of(const std::string& answer);
std::size_t count(const std::string& text, const std::string& part);

nlohmann::json json_of(const httplib::Result& answer);

}  // namespace cyanometer::testing
