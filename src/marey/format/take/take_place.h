#pragma once

#include <string>

namespace marey::format::take {

/// Where a new take of this name lies, links followed. Throws Error for what is no file, and for a file that is no take: it is
/// somebody's work, named by mistake.
std::string place_for_take(const std::string& path);

/// Removes the take that lies there, with what a program that was cut off has left beside it. Throws Error where it cannot.
void remove_old_take(const std::string& path);

}  // namespace marey::format::take
