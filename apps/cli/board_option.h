#pragma once

#include <string>

#include "command_line.h"

namespace marey::cli {

/// --board: a calibration board, as `parse_board` reads it.
Option add_board(Command& command, std::string& board);

}  // namespace marey::cli
