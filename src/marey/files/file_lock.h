#pragma once

#include <string>

namespace marey {

/// While it lives, no one else has a lock on this path, in this process or another. The kernel releases it when the process ends,
/// however it ends. Held on a file beside the path (with "-lock" behind its name), which goes away with the lock: a lock on the
/// SQLite file itself would be lost with the first of its handles that the process closes.
class FileLock {
 public:
  /// Throws Error if another has the lock, and where the folder cannot be written.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::string lock_path_;
  int file_ = -1;
};

/// True where another holds the lock, or was killed while it did.
bool has_lock_file(const std::string& path);

}  // namespace marey
