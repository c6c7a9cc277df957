#include "marey/files/file_lock.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey {
namespace {

/// Whether the name still is that of the open file, and not of one that came after it.
bool is_file_of(int file, const std::string& path) {
  struct stat opened{};
  struct stat named{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(const std::string& path) : lock_path_(path + "-lock") {
  for (;;) {
    file_ = open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw Error("{}: cannot be written ({})", path, std::generic_category().message(errno));
    // A share that knows no locks is written without one: names of temporary files never collide.
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(file_);
      throw Error("{}: is being written by another run; wait until it is done, or choose another name", path);
    }
    // The one who had it before may have removed the file between our two calls.
    if (is_file_of(file_, lock_path_)) return;
    close(file_);
  }
}

FileLock::~FileLock() {
  unlink(lock_path_.c_str());
  close(file_);
}

bool has_lock_file(const std::string& path) {
  return access((path + "-lock").c_str(), F_OK) == 0;
}

}  // namespace marey
