#pragma once

#include <optional>

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/board/board_detector.h"
#include "marey/core/geometry.h"
#include "marey/geometry/lens.h"
#include "marey/geometry/rigid.h"

namespace marey::calibrate::board {

/// Where a board stands before a camera whose lens is known (camera_from_board, m): from its homography, refined. A flat board seen
/// from far has two such poses; this is the one that fits better. Nothing if fewer than four corners are seen, or they lie on a
/// line.
std::optional<Rigid3> board_pose(const Board& board, const BoardView& view, const geometry::Lens& lens);

/// Root of the mean squared distance between the corners seen and those predicted, px; nothing if a corner is behind the camera.
std::optional<double> board_rms(const Board& board, const BoardView& view, const geometry::Lens& lens,
                                const Rigid3& camera_from_board);

/// The pixel of a point in the camera's frame; nothing if it lies behind a camera that sees only ahead.
std::optional<Vector<2>> pixel_of(const geometry::Lens& lens, const Vector<3>& in_camera);

}  // namespace marey::calibrate::board
