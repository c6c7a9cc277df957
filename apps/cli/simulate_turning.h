#pragma once

#include "command_line.h"

namespace marey::cli {

/// `marey simulate turning`.
void add_simulate_turning(Command& simulate);

}  // namespace marey::cli
