#include "support/data.h"

#include <cstdlib>
#include <filesystem>

namespace marey::test {

std::string data(const std::string& name) {
  const char* folder = std::getenv("MAREY_DATA");
  const std::filesystem::path root =
      folder != nullptr ? std::filesystem::path(folder) : std::filesystem::path(MAREY_ROOT) / "../shared/data";
  return (root / name).lexically_normal().string();
}

std::string of_project(const std::string& name) {
  return (std::filesystem::path(MAREY_ROOT) / name).string();
}

std::string vtest() {
  return "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
}

}  // namespace marey::test
