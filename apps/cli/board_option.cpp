#include "board_option.h"

#include "marey/calibrate/board/board.h"

namespace marey::cli {

Option add_board(Command& command, std::string& board) {
  Option option = command.text("--board", board,
                               "chess:9x6:0.025 (inner corners, m), charuco:COLSxROWS:SQUARE:MARKER:DICT or a sheet of markers, "
                               "aruco:COLSxROWS:MARKER:GAP:DICT[:FIRST], :inverted behind it where black and white are exchanged");
  return option.check([](const std::string& text) { calibrate::board::parse_board(text); });
}

}  // namespace marey::cli
