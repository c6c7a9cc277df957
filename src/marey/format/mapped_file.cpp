#include "marey/format/mapped_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/format/read_file.h"

namespace marey::format {

MappedFile::MappedFile(const std::string& path) {
  struct stat status{};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    if (S_ISDIR(status.st_mode)) throw Error("{}: is a folder, not a file", path);
    read_ = read_file(path);
    return;
  }
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    if (errno == ENOENT) throw Error("{}: no such file", path);
    throw Error("{}: cannot be read ({})", path, std::generic_category().message(errno));
  }
  const bool regular = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  if (regular && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    data_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  }
  const int error = errno;
  close(file);
  if (!regular) throw Error("{}: is not a file", path);
  if (data_ == MAP_FAILED) {
    data_ = nullptr;
    throw Error("{}: cannot be read ({})", path, std::generic_category().message(error));
  }
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) munmap(data_, size_);
}

}  // namespace marey::format
