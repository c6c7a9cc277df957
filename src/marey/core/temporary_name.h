#pragma once

#include <string>

namespace marey {

/// What the file `path` is called until it is whole: beside it, ending in ".part", and no other writer's, of this program or
/// another, so that two that write the same file do not mix: the one that is finished last stays.
std::string temporary_name(const std::string& path);

}  // namespace marey
