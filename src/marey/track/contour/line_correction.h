#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/contour_target.h"
#include "marey/track/contour/line_search.h"

namespace marey::track::contour {

/// The paper's two filters for one target and frame: predicted by the motion, corrected by measurement lines across the outline.
class LineCorrection {
 public:
  /// `lines` measurement lines an outline.
  explicit LineCorrection(int lines) : locations_(static_cast<std::size_t>(lines)) {}

  /// To a frame `dt` seconds later.
  void predict(ContourTarget& target, double dt);

  /// Searches the lines in `mask` (CV_8UC1, 255 foreground) and corrects the target by them; `all` are the targets that may own
  /// pixels, `target` among them. Says how much of it was seen (`state`).
  void correct(ContourTarget& target, std::span<const ContourTarget> all, const cv::Mat& mask, double dt);

 private:
  double foreground_fraction(const ContourTarget& target, const cv::Mat& mask) const;
  void position_lines(ContourTarget& target);
  void correct_shape(ContourTarget& target, int found, int askable, double dt);
  int trust_lines(ContourTarget& target);
  void note_hidden(ContourTarget& target);

  // What a frame needs, kept so that it is allocated once.
  std::vector<const colour::Footprint*> others_;
  std::vector<double> locations_, deviations_;
  std::vector<geometry::SplineWeights> weights_;
  std::vector<Vector<2>> polygon_;
  std::vector<int> requested_, answered_;  // by control point: lines that say something of it
};

}  // namespace marey::track::contour
