#pragma once

#include <string>
#include <vector>

#include "marey/core/planned_room.h"

namespace marey::draw {

/// A room from above with its cameras, and what they make of each part of the volume.
struct RoomPlan {
  struct Camera {
    std::string name;
    Vector<2> at = Vector<2>::Zero(), ahead = Vector<2>::UnitX();  ///< m; its direction, length 1
    double height = 0;                                             ///< m
    double field_of_view = 1;                                      ///< rad
  };
  /// A part of the volume, over its height.
  struct Cell {
    Vector<2> from = Vector<2>::Zero(), to = Vector<2>::Zero();  ///< m
    double covered = 0;                                          ///< share
    double error_m = 0;                                          ///< expected, where covered
  };

  std::string title, caption;
  PlannedRoom room;
  std::vector<Camera> cameras;
  std::vector<Cell> cells;
};

/// A self-contained SVG: x to the right, y upwards. Cells are green where they are covered whole, pale where not, with the share
/// and the expected error in mm.
std::string to_svg(const RoomPlan& plan);

}  // namespace marey::draw
