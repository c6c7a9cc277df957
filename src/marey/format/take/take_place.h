#pragma once

#include <string>

namespace marey::format::take {

/// Where a new take of this name lies, links followed. Throws Error for what is not a file, and for a file that is not a take: it
/// is a person's work, named by mistake.
std::string position_for_take(const std::string& path);

/// Removes the take that lies there, with what a program that was cut off has left beside it. Throws Error if it cannot.
void remove_old_take(const std::string& path);

}  // namespace marey::format::take
