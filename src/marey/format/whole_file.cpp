#include "marey/format/whole_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey {
namespace {

constexpr std::size_t buffer_limit = std::size_t{1} << 18;

std::string reason(int code) {
  return std::generic_category().message(code);
}

/// What stands at the end of a chain of symbolic links; the path itself where there is none.
std::string followed(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path;
  const auto target = std::filesystem::weakly_canonical(path, failed);
  return failed ? path : target.string();
}

}  // namespace

WholeFile::WholeFile(std::string path) : path_(std::move(path)), target_(followed(path_)) {
  if (path_.empty()) throw Error("the output file has no name; give a path, or - for standard output");
  if (path_ == "-") {
    descriptor_ = STDOUT_FILENO;
    owns_descriptor_ = false;
    renames_ = false;
    part_path_ = "/dev/stdout";
    return;
  }
  struct stat there{};
  const bool exists = ::stat(target_.c_str(), &there) == 0;
  if (exists && S_ISDIR(there.st_mode)) throw Error("{}: is a folder; give the name of a file to write", path_);
  renames_ = !exists || S_ISREG(there.st_mode);
  if (exists && ::access(target_.c_str(), W_OK) != 0) {
    throw Error("{}: cannot be written ({}); choose another name", path_, reason(errno));
  }
  open_part();
  if (renames_ && exists) ::fchmod(descriptor_, there.st_mode & 07777);
}

void WholeFile::open_part() {
  if (!renames_) {
    part_path_ = target_;
    descriptor_ = ::open(part_path_.c_str(), O_WRONLY | O_CLOEXEC);
  }
  const std::filesystem::path target(target_);
  for (int attempt = 0; renames_ && descriptor_ < 0; ++attempt) {
    const std::string name =
        fmt::format(".{}.part-{}-{}{}", target.stem().string(), ::getpid(), attempt, target.extension().string());
    part_path_ = (target.parent_path() / name).string();
    descriptor_ = ::open(part_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) {
    throw Error("{}: cannot be written ({}); choose a folder that exists and that you may write to", path_, reason(errno));
  }
}

WholeFile::~WholeFile() {
  close_descriptor();
  if (renames_ && !committed_) ::unlink(part_path_.c_str());
}

void WholeFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= buffer_limit) flush();
}

void WholeFile::flush() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int code = errno;
      buffer_.clear();
      fail(code);
    }
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void WholeFile::commit() {
  flush();
  if (!renames_) {
    close_descriptor();
    committed_ = true;
    return;
  }
  // A full disk may show only now; and a name must never point at bytes that a power cut can still take away.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail(errno);
  close_descriptor();
  if (::rename(part_path_.c_str(), target_.c_str()) != 0) fail(errno);
  committed_ = true;
}

void WholeFile::close_descriptor() {
  if (descriptor_ >= 0 && owns_descriptor_) ::close(descriptor_);
  descriptor_ = -1;
}

void WholeFile::fail(int code) const {
  const bool full = code == ENOSPC || code == EDQUOT;
  throw Error("{}: could not be written to the end ({}); {}", path_, reason(code),
              full ? "make room on the disk or choose another place" : "nothing was left under that name");
}

}  // namespace marey
