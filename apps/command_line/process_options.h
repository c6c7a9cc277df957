#pragma once

#include "command_line.h"

namespace marey::cli {

/// --limit NAME=N and --threads N, which hold for the whole process from the instant they are parsed.
void add_process_options(Command& command);

}  // namespace marey::cli
