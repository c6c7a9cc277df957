#pragma once

#include <memory>
#include <string>

#include "marey/core/skeleton.h"

#include "command_line.h"

namespace marey::cli {

/// --skeleton of who solves a pose with every instant.
void add_skeleton_option(Command& command, std::string& skeleton);

/// Null where none was named. Its doubts go to standard error. Throws Error where it is no skeleton, or one without markers.
std::shared_ptr<const Skeleton> skeleton_of(const std::string& path);

}  // namespace marey::cli
