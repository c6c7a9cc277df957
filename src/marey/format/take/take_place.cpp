#include "marey/format/take/take_place.h"

#include <filesystem>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"

namespace marey::format::take {

namespace fs = std::filesystem;

std::string position_for_take(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return path;
  if (!fs::is_regular_file(status)) throw Error("{}: is not a file; name one for the take", path);
  if (fs::file_size(path, error) > 0 && !is_take(path)) {
    throw Error("{}: exists and is not a take; it is not overwritten, choose another name", path);
  }
  return fs::canonical(path).string();
}

void remove_old_take(const std::string& path) {
  std::error_code error;
  fs::remove(path + "-journal", error);
  fs::remove(path, error);
  if (error) throw Error("{}: cannot be replaced ({})", path, error.message());
}

}  // namespace marey::format::take
