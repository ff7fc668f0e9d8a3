#include "server/batch/lock_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace cyanometer {

LockFile::LockFile(const std::filesystem::path& of) : path_(of.string() + ".lock") {
  for (;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) return;
    // Some file systems know no locks: then it is as it was without.
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file_);
      throw std::runtime_error("another run is writing " + of.string() +
                               ": wait for it, or give this one another folder or name");
    }
    if (is_still_there()) return;
    ::close(file_);
  }
}

LockFile::~LockFile() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

/// Who held it may have removed it between opening and locking.
bool LockFile::is_still_there() const {
  struct stat held {
  }, named{};
  return ::fstat(file_, &held) == 0 && ::stat(path_.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

}  // namespace cyanometer
