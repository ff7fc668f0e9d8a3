// A daemon of this same program, for as long as it is measured.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

class OwnDaemon {
 public:
  /// Starts it on a free port, whatever the environment says of settings.
  /// @param arguments  further ones of `serve`
  /// @throws std::runtime_error where it does not start, with what it said
  explicit OwnDaemon(const std::vector<std::string>& arguments);
  /// Waits until it has ended.
  ~OwnDaemon();
  OwnDaemon(const OwnDaemon&) = delete;
  OwnDaemon& operator=(const OwnDaemon&) = delete;

  /// @throws Cancelled, std::runtime_error where it ends before
  void wait_until_ready(const Watch& watch) const;

  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  int log_ = -1;  ///< read up to where it listens; what is lost beyond hinders it not
  int port_ = 0;
};

}  // namespace cyanometer
