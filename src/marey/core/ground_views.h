#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/geometry/ground_view.h"

namespace marey {

/// How each camera of a rig sees the ground, at any time: the one who needs a view asks here, with the time of the frame or instant
/// (by the rig's clock), so that a PTZ camera needs no stage of its own. A static camera has one view permanently.
///
/// Cameras are independent of each other: one thread a camera may turn it while others turn or are asked for theirs.
class GroundViews {
 public:
  /// CameraId i sees the ground as views[i], until it is turned.
  explicit GroundViews(std::vector<GroundView> views);

  int cameras() const { return static_cast<int>(cameras_.size()); }

  /// How the camera sees the ground at `time`: as it was last turned before, or just then. The reference stays valid. The camera
  /// must be one of the rig's.
  const GroundView& view_at(CameraId camera, Timestamp time) const;

  /// From `from` on the camera sees the ground so. Times of one camera ascend: throws Error for one that is not later than the
  /// last.
  void turn(CameraId camera, Timestamp from, const GroundView& view);

 private:
  struct Turn {
    Timestamp from;
    GroundView view;
  };
  struct OneCamera {
    GroundView first;
    std::deque<Turn> rotations;  // by time
  };
  std::vector<OneCamera> cameras_;
};

/// Of static cameras.
std::shared_ptr<GroundViews> ground_views(std::vector<GroundView> views);

}  // namespace marey
