#pragma once

#include "command_line.h"

namespace marey::cli {

/// `marey calibrate turning`.
void add_calibrate_turning(Command& calibrate);

}  // namespace marey::cli
