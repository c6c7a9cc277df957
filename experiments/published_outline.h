#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/geometry.h"
#include "marey/core/outline.h"
#include "marey/core/time.h"
#include "marey/track/contour/shape_filter.h"

namespace marey::experiments {

/// The parameters that the paper leaves open.
struct PublishedOptions {
  int order = 4;
  int control_points = 12;
  int lines = 24;
  double reach = 6;              ///< px each line extends to either side
  double shape_noise = 1;        ///< standard deviation of the control points' own motion, px a frame
  double measurement_noise = 1;  ///< px
  double velocity_noise = 0.5;   ///< px a frame, a frame
  double scale_noise = 0.01;     ///< a frame
};

/// One target followed as Arnaut & Costa (after De Bem) publish it: two coupled Kalman filters, measurement lines searched for
/// the strongest change of light, every line trusted, no reasoning about occlusion. For comparison: ContourTracker is Marey's.
class PublishedOutline {
 public:
  /// Begins with the silhouettes (closed polygons along pixel edges) of two consecutive frames, `now` being the later. Throws
  /// Error where an option is out of its domain or no spline fits a silhouette.
  PublishedOutline(const PublishedOptions& options, std::span<const Vector<2>> before, std::span<const Vector<2>> now);

  /// The next frame, which has an image. In the outline it returns, velocities are px/s and rates 1/s by the frames' times, from
  /// the second call on; before, a frame counts as a second.
  const Outline& step(const Frame& frame);
  const Outline& outline() const { return outline_; }

 private:
  void search(const cv::Mat& luma);
  void correct();
  void report();

  PublishedOptions options_;
  track::contour::ShapeFilter shape_;
  // The motion filter: velocity in px a frame, growth a frame; variances. The three do not mix, since nothing couples them.
  Vector<2> velocity_;
  double growth_;
  double velocity_variance_, growth_variance_;
  Vector<2> centre_;
  double arm_;  // px, from the centre to the first control point
  std::vector<geometry::SplineWeights> weights_;
  std::vector<double> locations_;
  std::optional<Timestamp> time_;
  std::optional<double> frame_seconds_;
  Outline outline_;
};

}  // namespace marey::experiments
