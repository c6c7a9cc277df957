#include "marey/format/whole_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "marey/core/error.h"
#include "marey/core/temporary_name.h"

namespace marey::format {

namespace fs = std::filesystem;

WholeFile::WholeFile(const std::string& path) : path_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw Error("{}: is a folder; name a file", path);
  const bool special = fs::exists(status) && !fs::is_regular_file(status);
  // Where the name is a link, the file behind it is what is replaced.
  if (!special) {
    target_ = fs::is_regular_file(status) ? fs::canonical(path, error).string() : path;
    part_ = temporary_name(target_);
  }
  file_.reset(std::fopen(special ? path.c_str() : part_.c_str(), "wb"));
  if (file_ == nullptr) fail(errno);
}

WholeFile::~WholeFile() {
  if (file_ == nullptr || part_.empty()) return;
  file_.reset();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void WholeFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail(errno);
}

void WholeFile::finish() {
  if (std::fflush(file_.get()) != 0) fail(errno);
  if (part_.empty()) {
    file_.reset();
    return;
  }
  if (std::fclose(file_.release()) != 0) {
    const int error = errno;
    std::error_code ignored;
    fs::remove(part_, ignored);
    fail(error);
  }
  std::error_code error;
  fs::rename(part_, target_, error);
  if (error) fail(error.value());
}

void WholeFile::fail(int error) const {
  throw Error("{}: cannot be written ({})", path_, std::generic_category().message(error));
}

}  // namespace marey::format
