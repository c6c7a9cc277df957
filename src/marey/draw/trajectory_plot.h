#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/core/track_names.h"

namespace marey::draw {

/// The trajectories of targets, in the coordinates of the image: a line each with its number where it begins, broken where nothing
/// is known of it. Memory grows with the paths' length, not with time: steps of less than half a pixel are skipped.
class TrajectoryPlot {
 public:
  /// Instants come in order; px. The place drawn is the outline's centre where there is an outline, else the target's position.
  void add(const Instant& instant);

  /// A self-contained SVG image that a browser shows: pixels to scale, y pointing down, axes with round numbers.
  std::string to_svg(const std::string& title) const;

 private:
  struct Trajectory {
    std::string name;
    std::vector<std::vector<Vector<2>>> pieces;
    Vector<2> last = Vector<2>::Zero();  // seen, if not drawn yet
    std::int64_t last_frame = 0;
  };
  std::map<TrackId, Trajectory> trajectories_;
  TrackNames names_;
};

}  // namespace marey::draw
