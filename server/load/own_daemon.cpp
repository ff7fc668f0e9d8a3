#include "server/load/own_daemon.h"

#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "server/config.h"

namespace cyanometer {
namespace {

/// Becomes the daemon. Its signals are not those of the terminal, and it does not outlive who
/// measures it.
[[noreturn]] void become_daemon(const std::vector<std::string>& arguments, int log) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const Setting& setting : settings()) unsetenv(setting.variable().c_str());
  dup2(log, STDERR_FILENO);
  std::vector<const char*> argv{"cyanometer", "serve", "--listen", "127.0.0.1:0"};
  for (const std::string& each : arguments) argv.push_back(each.c_str());
  argv.push_back(nullptr);
  execv("/proc/self/exe", const_cast<char* const*>(argv.data()));
  _exit(1);
}

/// The port that a line of the log tells of, or 0.
int told_port(const std::string& line) {
  const auto entry = nlohmann::json::parse(line, nullptr, false);
  return entry.is_object() && entry.value("event", "") == "listening" ? entry.value("port", 0)
                                                                      : 0;
}

/// Reads a log until it tells of a port. @throws std::runtime_error with all of it where it
/// ends
int read_port(int log) {
  std::string said;
  std::array<char, 4096> bytes;
  for (std::size_t line = 0;;) {
    const auto got = read(log, bytes.data(), bytes.size());
    if (got <= 0) throw std::runtime_error("the daemon does not start: " + said);
    said.append(bytes.data(), static_cast<std::size_t>(got));
    for (auto end = said.find('\n', line); end != said.npos; end = said.find('\n', line)) {
      if (const int port = told_port(said.substr(line, end - line))) return port;
      line = end + 1;
    }
  }
}

void end(pid_t daemon) {
  kill(daemon, SIGTERM);
  waitpid(daemon, nullptr, 0);
}

}  // namespace

OwnDaemon::OwnDaemon(const std::vector<std::string>& arguments) {
  std::array<int, 2> log;
  if (pipe2(log.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe for a daemon's log");
  pid_ = fork();
  if (pid_ == 0) become_daemon(arguments, log[1]);
  close(log[1]);
  log_ = log[0];
  try {
    if (pid_ < 0) throw std::runtime_error("no process for a daemon");
    port_ = read_port(log_);
  } catch (...) {
    if (pid_ > 0) end(pid_);
    close(log_);
    throw;
  }
}

OwnDaemon::~OwnDaemon() {
  end(pid_);
  close(log_);
}

void OwnDaemon::wait_until_ready(const Watch& watch) const {
  httplib::Client client(origin());
  for (;;) {
    watch.check();
    const auto answer = client.Get("/readyz");
    if (!answer) throw std::runtime_error("the daemon has ended");
    if (answer->status == 200) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace cyanometer
