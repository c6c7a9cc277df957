#pragma once

#include <string>

namespace marey::format {

/// The bytes of a file; "-" is standard input. Throws Error, one sentence that names `path`, where it cannot be read.
std::string read_file(const std::string& path);

}  // namespace marey::format
