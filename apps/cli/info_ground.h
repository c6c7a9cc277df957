#pragma once

#include <string>

namespace marey::cli {

/// Says what is in a file of people on the ground. `metadata` may be empty. Throws Error.
void report_ground(const std::string& file, const std::string& metadata, bool json, bool quiet);

}  // namespace marey::cli
