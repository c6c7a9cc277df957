#pragma once

#include "command_line.h"

namespace marey::cli {

/// `marey simulate ptz`.
void add_simulate_ptz(Command& simulate);

}  // namespace marey::cli
