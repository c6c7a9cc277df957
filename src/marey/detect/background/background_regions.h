#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"
#include "marey/detect/runs.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::background {

/// One frame's foreground before it is cleaned.
struct MarkedRuns {
  std::vector<PixelRun> runs;
  std::vector<int> strong;  ///< of each run: its pixels far outside the bands
  std::vector<int> solid;   ///< of each run: its pixels whose 3 × 3 round lies outside the bands
  double pixels = 0;
};

/// The connected regions of one frame's foreground that are large and sure enough, and what the edges along their borders say of
/// them: a thing that stands before the scene has its own edge in the frame; a ghost, where something of the first frames has
/// left, has one in the scene alone.
class ForegroundRegions {
 public:
  /// Keeps the runs of the regions that count, in order.
  void choose(const MarkedRuns& marked, int rows);

  /// Adds up, over the left and right borders of each region, how sharp the frame is there and how sharp the scene.
  void compare_borders(const cv::Mat& luma, const ScenePlane& scene);

  const std::vector<PixelRun>& runs() const { return runs_; }
  /// Which runs lie in the rows [first, last): from begin_of(first) to begin_of(last).
  std::size_t begin_of(int row) const { return row_begin_[row]; }
  bool is_ghost(std::size_t run) const { return borders_[region_[run]].is_ghost(); }
  bool is_thing(std::size_t run) const { return borders_[region_[run]].is_thing(); }

 private:
  struct Border {
    double frame = 0, scene = 0;
    int count = 0;
    bool is_ghost() const { return count >= 8 && scene > 2 * frame + 4 * count; }
    bool is_thing() const { return frame > 1.3 * scene; }
  };

  assign::DisjointSets sets_;
  std::vector<int> areas_, strongs_, solids_, numbers_;
  std::vector<PixelRun> runs_;
  std::vector<int> region_;             ///< of each run
  std::vector<Border> borders_;         ///< of each region
  std::vector<std::size_t> row_begin_;  ///< the first run of each row
};

}  // namespace marey::detect::background
