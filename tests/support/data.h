#pragma once

#include <string>

namespace marey::test {

/// A file of the test data that is kept outside the project (CONTRIBUTING.md); the environment variable MAREY_DATA says where.
/// A test that finds it missing skips: `if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";`
std::string data(const std::string& name);

/// A file of the project itself: "docs/formats.md".
std::string of_project(const std::string& name);

/// The street video that Debian's opencv-doc brings.
std::string vtest();

}  // namespace marey::test
