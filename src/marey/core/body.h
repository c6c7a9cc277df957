// Bodies: rigid ones, and the segments of a skeleton, which are the same in a recording. Each has a frame of its own, fixed to it,
// and at each instant a pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/geometry/rigid.h"

namespace marey {

/// A marker that is fixed to a body.
struct BodyMarker {
  std::string label;
  Vector<3> position = Vector<3>::Zero();  ///< m, in the body's frame

  bool operator==(const BodyMarker&) const = default;
};

/// What a body is, apart from where it is. A skeleton is its segments: they have its name, and each hangs on its parent.
struct Body {
  BodyId id{};
  std::string label;             ///< "racket"; of a segment "LeftFoot"
  std::string skeleton;          ///< whose segment it is; empty for a body by itself
  std::optional<BodyId> parent;  ///< which segment it hangs on, and which comes before it; nothing for a root and a body by itself
  Vector<3> offset = Vector<3>::Zero();  ///< m: its origin in its parent's frame at rest, where axes of all segments are parallel
  std::optional<Vector<3>> end;          ///< m, in its frame: where a segment without children ends
  std::vector<BodyMarker> markers;

  bool operator==(const Body&) const = default;
};

/// Where else a body may be that appears the same when it is turned.
struct OtherPose {
  Rigid3 world_from_body;  ///< m
  double probability = 0;  ///< that it is this one
};

/// Where a body is at one instant.
struct BodyPose {
  BodyId body{};
  Rigid3 world_from_body;               ///< m
  std::optional<Matrix<6>> covariance;  ///< of a small turn about the world's axes (rad), then of the position (m)
  std::optional<double> residual_m;     ///< mean distance of its markers from where they were seen
  bool tracked = true;                  ///< enough of it was seen at this instant; otherwise it is predicted
  std::optional<OtherPose> other = {};  ///< the most probable of those that its markers cannot exclude, where it is in question
};

}  // namespace marey
