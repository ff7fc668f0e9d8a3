// The program, run as its users run it.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/accuracy/temporary_folder.h"

namespace cyanometer::testing {

/// The program stands beside the tests.
inline std::filesystem::path program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cyanometer";
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A run of the program; its output is read when it has ended.
class Program {
 public:
  /// @param errors  where its standard error goes, unless to err()
  Program(const std::vector<std::string>& arguments, const std::string& input = "",
          const std::string& errors = "") {
    std::ofstream(folder_ / "in") << input;
    std::fflush(nullptr);  // or the child writes it once more
    pid_ = fork();
    if (pid_ != 0) return;
    const auto redirect = [&](const std::string& path, const char* mode, FILE* stream) {
      if (!freopen(path.c_str(), mode, stream)) _exit(99);
    };
    redirect(folder_ / "in", "r", stdin);
    redirect(folder_ / "out", "w", stdout);
    redirect(errors.empty() ? (folder_ / "err").string() : errors, "w", stderr);
    std::vector<char*> argv;
    const std::string path = program();
    argv.push_back(const_cast<char*>(path.c_str()));
    for (const auto& each : arguments) argv.push_back(const_cast<char*>(each.c_str()));
    argv.push_back(nullptr);
    execv(path.c_str(), argv.data());
    _exit(98);
  }
  ~Program() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      wait();
    }
  }
  int wait() {
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  void signal(int number) const { kill(pid_, number); }
  pid_t pid() const { return pid_; }
  std::string out() const { return read_file(folder_ / "out"); }
  std::string err() const { return read_file(folder_ / "err"); }
  /// The port of a daemon, once it says it; or its "ops_port".
  int port(const std::string& name = "port") const {
    const std::string field = "\"" + name + "\":";
    for (int i = 0; i < 2000; ++i) {
      const auto text = err();
      const auto at = text.find(field);
      if (at != std::string::npos) return std::stoi(text.substr(at + field.size()));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << err();
    return 0;
  }

 private:
  TemporaryFolder folder_;
  pid_t pid_;
};

}  // namespace cyanometer::testing
