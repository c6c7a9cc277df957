#pragma once

#include <string>
#include <vector>

namespace marey::cli {

/// The parts of "a,b,c", without blanks round them. Throws Error for an empty one, and for one that occurs twice.
std::vector<std::string> labels_in(const std::string& text);

}  // namespace marey::cli
