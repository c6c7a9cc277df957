#pragma once

#include <span>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/outline.h"
#include "marey/geometry/vector.h"

namespace marey {

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
/// the strongest change of light, every line believed, no reasoning about occlusion. For comparison: OutlineFollower is Marey's.
class PublishedOutline {
 public:
  /// Begins with the silhouettes (closed polygons along pixel edges) of two consecutive frames, `now` being the later. Throws
  /// Error where an option is out of its domain or no spline fits a silhouette.
  PublishedOutline(const PublishedOptions& options, std::span<const Vector<2>> before, std::span<const Vector<2>> now);

  /// The next frame. Velocities in the outline are px/s by the frames' times.
  const Outline& step(const Frame& frame);
  const Outline& outline() const { return outline_; }

 private:
  Outline outline_;
};

}  // namespace marey
