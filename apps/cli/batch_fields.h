#pragma once

#include <string>
#include <vector>

namespace marey::cli {

/// The fields of a line of a table; as many as there are separators, and one.
std::vector<std::string> split_fields(const std::string& text, char separator);

}  // namespace marey::cli
