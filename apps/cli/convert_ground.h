#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command_line.h"

namespace marey::cli {

/// What `marey convert` must be told of people on the ground beyond the files.
struct GroundConversion {
  std::string metadata, rig, home, away, size = "105x68";
  std::vector<std::string> periods;
  double rate_hz = 25;
  bool y_down = false, centred = false;
};

void add_ground_conversion(Command& command, GroundConversion& options);

struct GroundWritten {
  std::string format;
  std::int64_t places = 0;
};

/// Reads `from` and writes `to`; `format` is a name, or empty where the ending says it. Throws Error.
GroundWritten convert_ground(const std::string& from, const std::string& to, const std::string& format,
                             const GroundConversion& options);

/// A take of people on the ground.
bool is_take_of_ground(const std::string& path);

}  // namespace marey::cli
