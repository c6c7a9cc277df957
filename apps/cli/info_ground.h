#pragma once

#include <string>

namespace marey::cli {

/// Says what is in a file of people on the ground. `metadata` may be empty. Throws Error.
void tell_ground(const std::string& file, const std::string& metadata, bool json);

}  // namespace marey::cli
