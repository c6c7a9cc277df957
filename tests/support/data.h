#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace marey::test {

/// A file of the test data that is kept outside the project (CONTRIBUTING.md); the environment variable MAREY_DATA says where.
/// A test that finds it missing skips: `if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";`
inline std::string data(const std::string& name) {
  const char* folder = std::getenv("MAREY_DATA");
  const std::filesystem::path root =
      folder != nullptr ? std::filesystem::path(folder) : std::filesystem::path(MAREY_ROOT) / "../shared/data";
  return (root / name).lexically_normal().string();
}

/// The street video that Debian's opencv-doc brings.
inline std::string vtest() {
  return "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
}

}  // namespace marey::test
