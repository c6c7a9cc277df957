#include "marey/core/temporary_name.h"

#include <atomic>

#include <fmt/format.h>
#include <unistd.h>

namespace marey {

std::string temporary_name(const std::string& path) {
  static std::atomic<int> writers = 0;
  return fmt::format("{}.{}-{}.part", path, getpid(), ++writers);
}

}  // namespace marey
