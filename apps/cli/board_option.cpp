#include "board_option.h"

#include "marey/calibrate/board/board.h"

namespace marey::cli {

Option add_board(Command& command, std::string& board) {
  Option option = command.text("--board", board,
                               "chess:9x6:0.025 (inner corners, m) or charuco:COLSxROWS:SQUARE:MARKER:DICT, :inverted behind it "
                               "where black and white are exchanged");
  return option.check([](const std::string& text) { calibrate::board::parse_board(text); });
}

}  // namespace marey::cli
