// That one process at a time works on a file.
#pragma once

#include <filesystem>

namespace cyanometer {

/// Holds FILE.lock beside a file while it lives; a process that is killed leaves it free.
class LockFile {
 public:
  /// @throws std::runtime_error where another holds it
  explicit LockFile(const std::filesystem::path& of);
  ~LockFile();
  LockFile(const LockFile&) = delete;

 private:
  bool is_still_there() const;

  std::filesystem::path path_;
  int file_ = -1;  ///< where nothing can be written there is nothing to hold
};

}  // namespace cyanometer
