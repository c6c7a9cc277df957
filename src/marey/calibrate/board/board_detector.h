#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/calibrate/board/board.h"
#include "marey/core/image.h"

namespace marey::calibrate::board {

/// One corner of a board, seen.
struct BoardCorner {
  int id = 0;  ///< which: Board::corner
  Vector<2> pixel = Vector<2>::Zero();
};

/// A board in one image: corners by rising id. A chess board is seen atomically.
struct BoardView {
  std::vector<BoardCorner> corners;
};

/// Finds a board in images. A ChArUco board or a sheet of markers on glass or record that is seen from behind shows its markers
/// mirrored; its corners are where they are all the same, and a pose from them has the camera on the board's other side. A chess
/// board's back is not a different from its front, and is taken for it.
class BoardDetector {
 public:
  explicit BoardDetector(const Board& board);
  ~BoardDetector();
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;

  const Board& board() const { return board_; }

  /// Nothing if the board is not in the image or fewer than four of its corners are seen. Corners are refined to a fraction of
  /// a pixel.
  std::optional<BoardView> detect(const Image& image) const;

 private:
  std::optional<BoardView> chess(const cv::Mat& grey) const;
  std::optional<BoardView> charuco(const cv::Mat& grey) const;
  std::optional<BoardView> aruco(const cv::Mat& grey) const;
  std::optional<BoardView> from_either_side(const cv::Mat& grey) const;

  Board board_;
  struct Markers;
  std::unique_ptr<Markers> markers_;
};

}  // namespace marey::calibrate::board
