#pragma once

#include <string>

#include "marey/core/recording.h"

namespace marey::format {

/// What a recording's header says of a file that it was made from: its name without the folder, and 16 hexadecimal digits, FNV-1a
/// of 64 bits over its size (8 bytes, little-endian), its first MiB, and its last MiB where it is longer. They show whether it is
/// the file that was read, not who changed it. Without them for what is not a regular file, or cannot be read.
MadeBy::Input input_of(const std::string& path);

}  // namespace marey::format
