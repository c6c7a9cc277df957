#pragma once

#include <limits>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::detect {

/// Neighbouring pixels of one row: columns `begin` up to, not including, `end`.
struct PixelRun {
  int row = 0;
  int begin = 0;
  int end = 0;

  bool operator==(const PixelRun&) const = default;
};

/// Pixels that touch one another, by an edge or a corner.
struct Region {
  std::vector<PixelRun> runs;            ///< row by row from the top, in a row from the left; no two touch in a row; never empty
  double area = 0;                       ///< px², holes that were filled included
  Box box;                               ///< px; tight
  Vector<2> centre = Vector<2>::Zero();  ///< px; mean of the pixels
};

struct RegionOptions {
  double min_area = 1;                                        ///< px²; smaller regions are omitted
  double max_hole = std::numeric_limits<double>::infinity();  ///< px²; larger holes stay open
};

/// The regions of `mask` (CV_8UC1, zero is background), ordered by their first pixel, row by row. A hole is background that
/// is cut off from the border of the image by regions, touching by edges only; it is filled.
std::vector<Region> find_regions(const cv::Mat& mask, const RegionOptions& options = {});

/// A region of the pixels in `runs`, which are in order and may come from several regions that were joined.
Region region_of(std::vector<PixelRun> runs);

/// Of the pixels in `runs`, which are in order, the part with the largest area whose pixels touch one another, by an edge or a
/// corner; the first of several. Empty if `runs` is.
std::vector<PixelRun> largest_part(std::span<const PixelRun> runs);

/// The closed polygon round the pixels of a region, along their edges: corners lie half a pixel off the integers, each once,
/// clockwise as seen on the screen, no three in a line. Of a region in several parts, the part that holds the first run.
/// Without holes, its area by the shoelace formula is the number of its pixels.
std::vector<Vector<2>> outline_of(std::span<const PixelRun> runs);

}  // namespace marey::detect
