#pragma once

#include "command_line.h"

namespace marey::cli {

/// `marey calibrate ptz`.
void add_calibrate_ptz(Command& calibrate);

}  // namespace marey::cli
